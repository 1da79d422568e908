// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/screen_painter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gcs/screen/drawing/braille.hpp"
#include "gcs/screen/drawing/map_drawing.hpp"
#include "gcs/screen/drawing/widgets.hpp"
#include "gcs/screen/map_scene.hpp"
#include "gcs/screen/panels.hpp"

namespace swiftlet::screen {
namespace {

/// From here on there is room for a column on the right.
constexpr int kWide = 120;
/// Rows below them from which on there is room for health and link.
constexpr int kLeastForLink = 9;
/// The first row below the header and a line.
constexpr int kTop = 2;

bool edits_waypoints(const Controller& controller) {
  return controller.keyboard() == Keyboard::kWaypoints ||
         (controller.keyboard() != Keyboard::kFly &&
          controller.keyboard_below() == Keyboard::kWaypoints);
}

/// A line above an area, with the area's title in it.
void title(const Pane& screen, const Area& area, const std::string& text) {
  if (area.height == 0) return;
  const Pane line = screen.part({area.x, area.y - 1, area.width, 1});
  line.horizontal(0);
  const int end = line.text(1, 0, " " + text + " ", kBold);
  if (end < line.width()) line.put(end, 0, U'─', kDim);
  if (area.y <= kTop) return;
  // It meets the lines between columns.
  screen.put(area.x - 1, area.y - 1, U'├', kDim);
  screen.put(area.x + area.width, area.y - 1, U'┤', kDim);
}

/// A line between two columns of the screen, from the line below the header on.
void separate(const Pane& column) {
  column.vertical(0);
  column.put(0, 0, U'┬', kDim);
}

std::string map_title(const GroundStationModel& model, const Controller& controller) {
  const auto& cursor = controller.cursor();
  if (cursor) {
    std::string text = fmt::format("cursor {:.2f} {:.2f}", cursor->x(), cursor->y());
    if (model.pose().known()) {
      text += fmt::format(", {:.1f} m away", (*cursor - model.pose()->p_WB.head<2>()).norm());
    }
    return text;
  }
  switch (controller.camera().mode()) {
    case MapCamera::Mode::kAll:
      return "Map, all of it";
    case MapCamera::Mode::kFollow:
      return "Map, following";
    case MapCamera::Mode::kFree:
      return "Map";
  }
  return "Map";
}

MapScene scene_of(const GroundStationModel& model, const Controller& controller, Time now) {
  MapScene scene = scene_of(model, now);
  const auto& items = controller.waypoints().items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto place = place_in_map(items[i].item, model.origin());
    if (place) scene.waypoints.push_back({static_cast<int>(i) + 1, *place});
  }
  if (edits_waypoints(controller)) scene.selected = controller.waypoints().selected() + 1;
  scene.cursor = controller.cursor();
  return scene;
}

void paint_map(const Pane& pane, const GroundStationModel& model, Controller& controller,
               MapPicture& picture, Time now) {
  const MapScene scene = scene_of(model, controller, now);
  const auto vehicle =
      scene.vehicle ? std::optional(scene.vehicle->position) : std::optional<Eigen::Vector2d>();
  const MapView& view =
      controller.camera().update(pane.width() * Braille::kAcross, pane.height() * Braille::kDown,
                                 model.map_extent(), vehicle, scene.cursor);
  draw_map(pane, model.map(), view, scene, picture);
  if (model.map() == nullptr) pane.text(1, 0, "no map heard yet", kDim);
}

void paint_dialog(const Pane& screen, const GroundStationModel& model, Controller& controller,
                  Time now) {
  const bool below = controller.keyboard() == Keyboard::kText;
  const Keyboard keyboard = below ? controller.keyboard_below() : controller.keyboard();
  const Pane body = screen.part({0, 1, screen.width(), screen.height() - 3});
  if (keyboard == Keyboard::kHelp) {
    const Keyboard about = controller.keyboard_below();
    paint_help(draw_dialog(body, fmt::format("Help: {}", to_string(about)), 76, 26), about);
  } else if (keyboard == Keyboard::kEvents) {
    const Pane inside = draw_dialog(body, "Events", body.width(), body.height());
    controller.limit_events_up(paint_events(inside, model.log(), controller.events_up()));
  } else if (keyboard == Keyboard::kLink) {
    paint_link(draw_dialog(body, "Link", 56, 26), model, now);
  } else if (keyboard == Keyboard::kParameters) {
    const ParameterList& list = controller.parameters();
    const std::string& component = list.component;
    paint_parameters(draw_dialog(body, component.empty() ? "Parameters of" : component, 76, 40),
                     list);
  }
}

}  // namespace

Layout layout_of(int width, int height, bool edits_waypoints, int values) {
  Layout layout;
  layout.header = {0, 0, width, 1};
  layout.message = {0, height - 2, width, 1};
  layout.hints = {0, height - 1, width, 1};
  const int top = kTop;
  const int bottom = height - 2;
  const bool wide = width >= kWide;
  const int left = wide ? 34 : std::max(22, width / 3 - 1);
  const int right = wide ? std::max(38, width / 4) : 0;
  // The horizon is about as high as it is wide, where there is room.
  const int horizon = std::clamp((bottom - top) - values - 4, 3, left / 3);
  const int flight = horizon + values;
  layout.flight = {0, top, left, flight};
  const int below = top + flight + 1;
  const Area rest{0, below, left, bottom - below};
  const int map_x = left + 1;
  const int map_width = width - map_x - (right > 0 ? right + 1 : 0);
  if (wide) {
    const int link = rest.height < kLeastForLink ? 0 : std::min(rest.height / 2, 14);
    layout.health = {0, below, left, rest.height - (link > 0 ? link + 1 : 0)};
    layout.link = {0, bottom - link, left, link};
    layout.map = {map_x, top, map_width, bottom - top};
    const int x = width - right;
    const int list = std::max(4, (bottom - top) / 3);
    layout.waypoints = {x, top, right, list};
    layout.events = {x, top + list + 1, right, bottom - top - list - 1};
    return layout;
  }
  (edits_waypoints ? layout.waypoints : layout.health) = rest;
  const int events = std::clamp((bottom - top) / 5, 3, 8);
  layout.events = {map_x, bottom - events, map_width, events};
  layout.map = {map_x, top, map_width, bottom - top - events - 1};
  return layout;
}

void paint(Surface& surface, const GroundStationModel& model, Controller& controller,
           MapPicture& picture, Time now) {
  surface.clear();
  const Pane screen(surface);
  if (!is_large_enough(surface.width(), surface.height())) {
    screen.text(0, 0,
                fmt::format("too small: {} x {}, needs {} x {}", surface.width(), surface.height(),
                            kLeastWidth, kLeastHeight),
                kWarning);
    screen.text(0, 1, "only the space bar works: it stops the vehicle", kWarning);
    return;
  }
  const Layout layout =
      layout_of(surface.width(), surface.height(), edits_waypoints(controller), flight_rows(model));
  const int rows = layout.message.y - 1;
  separate(screen.part({layout.map.x - 1, 1, 1, rows}));
  if (layout.map.x + layout.map.width < screen.width()) {
    separate(screen.part({layout.map.x + layout.map.width, 1, 1, rows}));
  }
  title(screen, layout.flight, "Flight");
  title(screen, layout.health, "Health");
  title(screen, layout.link, "Link");
  title(screen, layout.waypoints, "Waypoints");
  title(screen, layout.events, "Events");
  paint_map(screen.part(layout.map), model, controller, picture, now);
  title(screen, layout.map, map_title(model, controller));
  paint_header(screen.part(layout.header), model, now);
  paint_flight(screen.part(layout.flight), model, now);
  if (layout.health.height > 0) paint_health(screen.part(layout.health), model, now);
  if (layout.link.height > 0) paint_link(screen.part(layout.link), model, now);
  if (layout.waypoints.height > 0)
    paint_waypoints(screen.part(layout.waypoints), controller, model.origin());
  paint_events(screen.part(layout.events), model.log());
  paint_dialog(screen, model, controller, now);
  paint_message(screen.part(layout.message), model, controller, now);
  paint_hints(screen.part(layout.hints), controller);
}

}  // namespace swiftlet::screen
