// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/basics/time.hpp"
#include "nav_msgs.h"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// nav_msgs/OccupancyGrid of a grid: 0 to 100 % occupied, -1 unknown, row by row from the lowest y.
nav_msgs::msg::OccupancyGrid to_msg(const OccupancyGrid& grid, Time time);

/// The grid of a message, with its resolution and otherwise `params`. An empty grid where the
/// message contradicts itself or is turned against the map's axes.
OccupancyGrid from_msg(const nav_msgs::msg::OccupancyGrid& message, OccupancyGrid::Params params);

}  // namespace swiftlet
