// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_edit.hpp"

#include <fmt/format.h>

#include "gcs/mission/mission_text.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;

Status check_number(const std::vector<MissionItem>& items, std::size_t number) {
  if (number >= 1 && number <= items.size()) return {};
  if (items.empty()) return Error{"the mission has no items"};
  return Error{
      fmt::format("there is no item {}; the mission has items 1 to {}", number, items.size())};
}

Status check_item(const MissionItem& item) {
  const std::string problem = problem_of(item);
  if (problem.empty()) return {};
  return Error{problem};
}

bool ends_mission(const MissionItem& item) {
  return item.kind == Kind::kLand || item.kind == Kind::kReturn;
}

}  // namespace

Result<std::size_t> add_waypoint(std::vector<MissionItem>& items, const MissionItem& waypoint,
                                 std::optional<std::size_t> at) {
  if (const Status makes_sense = check_item(waypoint); !makes_sense) return makes_sense.error();
  std::size_t index = items.size();
  if (at) {
    if (*at < 1 || *at > items.size() + 1) {
      return Error{
          fmt::format("a waypoint cannot be put at {}; the mission has {} items, so from "
                      "1 to {}",
                      *at, items.size(), items.size() + 1)};
    }
    index = *at - 1;
  } else if (!items.empty() && ends_mission(items.back())) {
    --index;
  }
  items.insert(items.begin() + static_cast<std::ptrdiff_t>(index), waypoint);
  return index + 1;
}

Status move_waypoint(std::vector<MissionItem>& items, std::size_t number,
                     const MissionItem& waypoint) {
  if (const Status there = check_number(items, number); !there) return there;
  const MissionItem& before = items[number - 1];
  if (before.kind != Kind::kWaypoint) {
    return Error{fmt::format("item {} is no waypoint but '{}'", number, item_text(before))};
  }
  if (before.global.has_value() != waypoint.global.has_value()) {
    return Error{fmt::format(
        before.global ? "item {} is a place on Earth; give latitude, longitude and altitude, with "
                        "--gps"
                      : "item {} is a place in the map; give x, y and z, without --gps",
        number)};
  }
  MissionItem after = before;
  after.place.position = waypoint.place.position;
  after.global = waypoint.global;
  if (waypoint.place.yaw) after.place.yaw = waypoint.place.yaw;
  if (waypoint.place.speed) after.place.speed = waypoint.place.speed;
  if (waypoint.hold > 0.0) after.hold = waypoint.hold;
  if (const Status makes_sense = check_item(after); !makes_sense) return makes_sense;
  items[number - 1] = after;
  return {};
}

Status remove_item(std::vector<MissionItem>& items, std::size_t number) {
  if (const Status there = check_number(items, number); !there) return there;
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(number - 1));
  return {};
}

}  // namespace swiftlet
