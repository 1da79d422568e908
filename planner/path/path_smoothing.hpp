// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/path/clearance_map.hpp"

namespace swiftlet {

using Polyline = std::vector<Eigen::Vector2d>;

/// Cost of a polyline; infinite where a part of it must not be flown.
double polyline_cost(const ClearanceMap& map, const Polyline& line);

/// The cheapest polyline through a subset of the points, first and last included, with a small
/// price a point: dynamic programming over all pairs at most `max_reach` points apart.
Polyline shortcut(const ClearanceMap& map, const Polyline& line, double price_per_point,
                  int max_reach = 24);

/// Leaves out points while the next one kept is within `spacing` [m] and can be reached in a line.
Polyline thin(const ClearanceMap& map, const Polyline& line, double spacing);

/// Points at most `spacing` [m] apart on the same line, its corners kept.
Polyline resample(const Polyline& line, double spacing);

/// Moves the inner points across the line, a little less every round, wherever that makes the line
/// cheaper. Never makes it dearer, hence never brings it into contact.
void relax(const ClearanceMap& map, Polyline& line, int rounds);

}  // namespace swiftlet
