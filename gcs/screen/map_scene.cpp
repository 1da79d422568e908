// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/map_scene.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/geometry/so3.hpp"
#include "gcs/screen/drawing/braille.hpp"

namespace swiftlet::screen {
namespace {

constexpr int kLeastRows = 5;
/// Columns and rows around what is known, which keep scale and north clear of it.
constexpr int kBorder = 2;

/// All that is known of the map, and the vehicle.
Extent shown_extent(const Extent& known, const MapScene& scene) {
  Extent extent = known;
  if (scene.vehicle) {
    extent.lower = extent.lower.cwiseMin(scene.vehicle->position);
    extent.upper = extent.upper.cwiseMax(scene.vehicle->position);
  }
  return extent;
}

/// How many metres a dot is, so that `length` [m] fits into so many terminal cells of `dots` each.
double metres_per_dot(double length, int cells, int dots) {
  return std::max(length, 1e-3) / (std::max(cells - kBorder, 1) * dots);
}

}  // namespace

MapScene scene_of(const GroundStationModel& model, Time now) {
  MapScene scene;
  const auto& pose = model.pose();
  if (pose.known() && pose->p_WB.allFinite()) {
    scene.vehicle = {pose->p_WB.head<2>(), yaw_of(pose->q_WB), !pose.fresh(now)};
  }
  if (model.vehicle().known() && model.vehicle()->in_flight && model.vehicle()->takeoff_point) {
    scene.pad = model.vehicle()->takeoff_point->head<2>();
  }
  if (model.path().known() && model.vehicle().known() && model.vehicle()->navigates)
    scene.path = *model.path();
  scene.trail = model.trail();
  return scene;
}

std::string map_text(const GroundStationModel& model, Time now, int width, bool ascii) {
  const auto& known = model.map_extent();
  if (!known) return "";
  const MapScene scene = scene_of(model, now);
  const Extent extent = shown_extent(*known, scene);
  const Eigen::Vector2d size = extent.upper - extent.lower;
  MapView view;
  view.centre = 0.5 * (extent.lower + extent.upper);
  view.metres_per_dot = metres_per_dot(size.x(), width, Braille::kAcross);
  const double rows = std::ceil(size.y() / (view.metres_per_dot * Braille::kDown)) + kBorder;
  const int most_rows = std::max(kLeastRows, width / 2);
  const int height = static_cast<int>(std::clamp(rows, 1.0 * kLeastRows, 1.0 * most_rows));
  view.metres_per_dot =
      std::max(view.metres_per_dot, metres_per_dot(size.y(), height, Braille::kDown));
  Surface surface(width, height);
  const Pane pane(surface);
  MapPicture picture;
  draw_map(pane, model.map(), view, scene, picture);
  return to_text(surface, ascii);
}

}  // namespace swiftlet::screen
