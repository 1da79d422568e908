// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The mission that is put together, item by item.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcs/screen/drawing/widgets.hpp"
#include "gcs/screen/panels.hpp"

namespace swiftlet::screen {
namespace {

/// From here on latitude and longitude have room.
constexpr int kWideEnough = 34;

std::string place_text(const MissionItem& item, bool is_wide,
                       const std::optional<LocalOrigin>& origin) {
  if (!item.global) {
    const Eigen::Vector3d& p = item.place.position;
    return fmt::format("{:6.2f} {:6.2f} {:4.1f}", p.x(), p.y(), p.z());
  }
  const auto place = place_in_map(item, origin);
  if (!is_wide && place) return fmt::format("gps {:.1f} {:.1f}", place->x(), place->y());
  return fmt::format("gps {:.5f} {:.5f}", item.global->latitude, item.global->longitude);
}

/// How a waypoint is flown to, and what is done there; each with a space before it.
std::string manner_text(const MissionItem& item) {
  std::string text;
  if (item.kind != MissionItem::Kind::kWaypoint) return text;
  if (item.global && item.global->altitude > 0.0) {
    text += fmt::format(" {:g} m", item.global->altitude);
  }
  if (item.place.speed) text += fmt::format(" {:g} m/s", *item.place.speed);
  if (item.place.yaw) text += fmt::format(" {}°", std::lround(*item.place.yaw * 180.0 / M_PI));
  if (item.hold > 0.0) text += fmt::format(" hold {:g} s", item.hold);
  return text;
}

std::string item_text(const MissionItem& item, bool is_wide,
                      const std::optional<LocalOrigin>& origin) {
  switch (item.kind) {
    case MissionItem::Kind::kTakeoff:
      return fmt::format("take off to {:g} m", item.altitude);
    case MissionItem::Kind::kWaypoint:
      return place_text(item, is_wide, origin);
    case MissionItem::Kind::kHold:
      return fmt::format("hold {:g} s", item.hold);
    case MissionItem::Kind::kLand:
      return "land";
    case MissionItem::Kind::kReturn:
      return "return";
    case MissionItem::Kind::kClaw:
      return item.open ? "open the claw" : "close the claw";
  }
  return "";
}

}  // namespace

void paint_waypoints(const Pane& pane, const Controller& controller,
                     const std::optional<LocalOrigin>& origin) {
  const MissionList& list = controller.waypoints();
  const bool edits = controller.keyboard() == Keyboard::kWaypoints ||
                     controller.keyboard_below() == Keyboard::kWaypoints;
  std::vector<Line> lines;
  if (list.empty()) {
    const char* what = edits ? "move the cursor with the arrows, then a: add; o: open a file"
                             : "none; w puts some together";
    for (const std::string& line : wrap(what, pane.width())) lines.push_back({line, kDim});
  }
  const bool is_wide = pane.width() >= kWideEnough;
  bool is_off_the_map = false;
  int selected_line = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const MissionItem& item = list.items()[i].item;
    const bool is_selected = static_cast<int>(i) == list.selected();
    const Style style = edits && is_selected ? kInverse : kPlain;
    if (is_selected) selected_line = static_cast<int>(lines.size());
    const std::string text = fmt::format("{:>3} {}", i + 1, item_text(item, is_wide, origin));
    const std::string manner = manner_text(item);
    if (columns_of(text) + columns_of(manner) <= pane.width()) {
      lines.push_back({text + manner, style});
    } else {
      lines.push_back({text, style});
      lines.push_back({"   " + manner, style});
    }
    is_off_the_map = is_off_the_map || (item.global && !origin);
  }
  if (is_off_the_map) {
    for (const std::string& line : wrap("gps: not on the map without a fix", pane.width())) {
      lines.push_back({line, kDim});
    }
  }
  draw_list(pane, lines, selected_line);
}

}  // namespace swiftlet::screen
