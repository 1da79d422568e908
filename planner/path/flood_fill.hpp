// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/path/clearance_map.hpp"

namespace swiftlet {

/// What a vehicle at one cell can reach.
struct FloodFill {
  std::vector<Cell> reached;  ///< in the order of being reached
  /// From start to goal, empty where the goal is not reached. Of a way from or to a place outside
  /// of the map the part inside: there it enters and leaves in a straight line.
  std::vector<Cell> to_goal;
  std::vector<Cell> narrow;  ///< of the reached, those on the ridge between near obstacles
};

/// Fills the free cells of the map from `start`, those first that a cheap way to the goal may lead
/// through (A* with a bucket queue), until the goal and what costs up to a tenth more is reached. A
/// goal that cannot be reached is known when all that can be is filled. Between free cells that
/// touch in a corner only, the way is open where their two common neighbours are free too: then
/// every point of the lines between their centres has the hard clearance. Start and goal may be
/// outside of an open map (cells by the same count, however far): it is filled from and to its
/// edges.
FloodFill flood_fill(const ClearanceMap& map, Cell start, Cell goal);

}  // namespace swiftlet
