// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// How well a place was explored: of all that a disc of `radius` [m] could sweep on its ways from
/// `start`, the share that `map` knows to be free. In `truth`, nothing is unknown. Passages that
/// are less than two cells wider than the disc may be missed.
double mapped_share(const OccupancyGrid& truth, const OccupancyGrid& map,
                    const Eigen::Vector2d& start, double radius);

}  // namespace swiftlet
