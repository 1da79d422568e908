// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/map_drawing.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gcs/screen/drawing/braille.hpp"

namespace swiftlet::screen {
namespace {

enum Layer { kWall, kTrail, kPath };

/// Eight ways to look, counter-clockwise from east.
constexpr char32_t kArrows[] = {U'→', U'↗', U'↑', U'↖', U'←', U'↙', U'↓', U'↘'};

class Drawing {
 public:
  Drawing(const Pane& pane, const MapView& view)
      : pane_(pane), view_(view), dots_(pane.width(), pane.height()) {}

  void draw_walls(const MapPicture& picture) {
    for (int y = 0; y < pane_.height(); ++y) {
      for (int x = 0; x < pane_.width(); ++x) draw_walls(picture, x, y);
    }
  }

  template <class Places>
  void polyline(const Places& places, Layer layer) {
    for (std::size_t i = 1; i < places.size(); ++i) {
      const Eigen::Vector2d a = at(places[i - 1]);
      const Eigen::Vector2d b = at(places[i]);
      dots_.line(a.x(), a.y(), b.x(), b.y(), layer);
    }
  }

  void flush() { dots_.draw(pane_, {kPlain, {Hue::kBlue}, {Hue::kCyan, true}}); }

  void mark(const Eigen::Vector2d& place, char32_t glyph, Style style) const {
    const Eigen::Vector2d dot = at(place);
    if (!inside(dot)) return;
    pane_.put(column(dot), row(dot), glyph, style);
  }

  void label(const Eigen::Vector2d& place, const std::string& text, Style style) const {
    const Eigen::Vector2d dot = at(place);
    if (inside(dot)) pane_.text(column(dot), row(dot), text, style);
  }

  /// At the edge where the place is not on the screen, so that one knows where to look.
  void mark_or_point(const Eigen::Vector2d& place, char32_t glyph, Style style) const {
    const Eigen::Vector2d dot = at(place);
    if (!dot.allFinite()) return;
    const double x = std::clamp(dot.x(), 0.0, dots_.width() - 1.0);
    const double y = std::clamp(dot.y(), 0.0, dots_.height() - 1.0);
    pane_.put(column({x, y}), row({x, y}), glyph, style);
  }

  void cross(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d dot = at(place);
    if (!inside(dot)) return;
    constexpr Style style{Hue::kMagenta, true, false, false};
    pane_.put(column(dot) - 1, row(dot), U'─', style);
    pane_.put(column(dot) + 1, row(dot), U'─', style);
    pane_.put(column(dot), row(dot) - 1, U'│', style);
    pane_.put(column(dot), row(dot) + 1, U'│', style);
    pane_.put(column(dot), row(dot), U'┼', style);
  }

 private:
  Eigen::Vector2d at(const Eigen::Vector2d& place) const {
    return to_dots(view_, dots_.width(), dots_.height(), place);
  }
  bool inside(const Eigen::Vector2d& dot) const {
    return dot.x() >= 0.0 && dot.y() >= 0.0 && dot.x() < dots_.width() && dot.y() < dots_.height();
  }
  static int column(const Eigen::Vector2d& dot) {
    return static_cast<int>(dot.x()) / Braille::kAcross;
  }
  static int row(const Eigen::Vector2d& dot) { return static_cast<int>(dot.y()) / Braille::kDown; }

  /// The walls of one cell of the screen; where there are none, whether anything was seen there.
  void draw_walls(const MapPicture& picture, int column, int row) {
    bool is_free = false;
    for (int y = row * Braille::kDown; y < (row + 1) * Braille::kDown; ++y) {
      for (int x = column * Braille::kAcross; x < (column + 1) * Braille::kAcross; ++x) {
        const MapPicture::Dot dot = picture.at(x, y);
        if (dot == MapPicture::Dot::kOccupied) dots_.dot(x, y, kWall);
        is_free = is_free || dot == MapPicture::Dot::kFree;
      }
    }
    if (is_free && (column + row) % 2 == 0) pane_.put(column, row, U'·', kDim);
  }

  const Pane& pane_;
  const MapView& view_;
  Braille dots_;
};

void draw_scale(const Pane& pane, const MapView& view) {
  const double per_column = view.metres_per_dot * Braille::kAcross;
  const double length = round_length(per_column * std::max(3, pane.width() / 4));
  const int columns = std::max(1, static_cast<int>(std::lround(length / per_column)));
  const int y = pane.height() - 1;
  for (int x = 0; x <= columns; ++x) pane.put(x, y, U'─', kPlain);
  pane.put(0, y, U'├', kPlain);
  pane.put(columns, y, U'┤', kPlain);
  pane.text(columns + 1, y, fmt::format(" {:g} m ", length));
  pane.text_before(pane.width(), 0, " ↑ N");
}

}  // namespace

double round_length(double longest) {
  if (!(longest > 0.0) || !std::isfinite(longest)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= longest * (1.0 + 1e-9)) return digit * power;
  }
  return power;
}

void draw_map(const Pane& pane, const std::shared_ptr<const GridMap>& map, const MapView& view,
              const MapScene& scene, MapPicture& picture) {
  picture.update(map, view, pane.width() * Braille::kAcross, pane.height() * Braille::kDown);
  Drawing drawing(pane, view);
  drawing.draw_walls(picture);
  drawing.polyline(scene.trail, kTrail);
  drawing.polyline(scene.path, kPath);
  drawing.flush();
  draw_scale(pane, view);
  if (scene.pad) drawing.mark(*scene.pad, U'H', {Hue::kGreen, true, false, false});
  for (const MapScene::Waypoint& waypoint : scene.waypoints) {
    drawing.label(waypoint.position, std::to_string(waypoint.number),
                  {Hue::kMagenta, true, false, scene.selected == waypoint.number});
  }
  if (scene.cursor) drawing.cross(*scene.cursor);
  if (scene.vehicle) {
    const double eighths = std::round(scene.vehicle->yaw / (0.25 * M_PI));
    const int eighth = std::isfinite(eighths) ? static_cast<int>(std::fmod(eighths, 8.0)) : 0;
    const Style style = scene.vehicle->stale ? kDim : Style{Hue::kYellow, true, false, false};
    drawing.mark_or_point(scene.vehicle->position, kArrows[(eighth + 8) % 8], style);
  }
}

}  // namespace swiftlet::screen
