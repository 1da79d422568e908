// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "perception/occupancy_grid.hpp"
#include "perception/slam/scan_points.hpp"

namespace swiftlet {

/// A room as its map has it.
struct Room {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< farthest from all walls [m]
  double area = 0.0;                                 ///< of its floor, furniture left out [m^2]
  double axis = 0.0;    ///< along which most walls stand or lie, from -45 to 45 degrees [rad]
  double length = 0.0;  ///< from wall to wall along the axis [m]; 0 where no walls are seen
  double width = 0.0;   ///< the same across it [m]
  /// As a floor plan has it, furniture included; of a room with four walls [m^2].
  double plan_area() const { return length * width; }
};

struct RoomSurveyParams {
  double widest_door = 1.0;  ///< what is narrower parts rooms [m]
  double least_core = 0.3;   ///< area where a room is wider than a door; less is none [m^2]
};

/// The rooms of a map, largest first: free places that hang together where they are wider than a
/// door, grown until they meet in the doorways. The grid says what is free and what belongs
/// together; where walls are to better than a cell, the points on their surfaces say (x, y in the
/// map, with normals).
std::vector<Room> survey_rooms(const OccupancyGrid& grid, const ScanPoints& surfaces,
                               const RoomSurveyParams& params = {});

}  // namespace swiftlet
