// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "gcs/screen/drawing/map_picture.hpp"
#include "gcs/screen/drawing/surface.hpp"

namespace swiftlet::screen {

/// What is drawn over a map; places in the map [m].
struct MapScene {
  struct Vehicle {
    Eigen::Vector2d position;
    double yaw = 0.0;  ///< counter-clockwise from east [rad]
    bool stale = false;
  };
  std::optional<Vehicle> vehicle;
  std::optional<Eigen::Vector2d> pad;  ///< where it took off
  std::vector<Eigen::Vector2d> path;   ///< that is flown
  std::deque<Eigen::Vector2d> trail;   ///< that was flown
  struct Waypoint {
    int number = 0;
    Eigen::Vector2d position;
  };
  std::vector<Waypoint> waypoints;
  std::optional<int> selected;  ///< number of a waypoint
  std::optional<Eigen::Vector2d> cursor;
};

/// Draws the map and what is on it, north up, with a scale in the lower left corner. `picture` is
/// kept by the caller, so that a map is looked through only when it is another.
void draw_map(const Pane& pane, const std::shared_ptr<const GridMap>& map, const MapView& view,
              const MapScene& scene, MapPicture& picture);

/// The greatest of 1, 2, 5, 10, ... metres (or parts of a metre) that is no longer than `longest`.
double round_length(double longest);

}  // namespace swiftlet::screen
