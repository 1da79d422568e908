// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "planner/path/clearance_map.hpp"
#include "planner/path/flood_fill.hpp"
#include "planner/path/path_smoothing.hpp"

namespace swiftlet {

struct FastMarchingTreeParams {
  int samples = 200;
  double guided_share = 0.6;  ///< of the samples, from around the way that the fill found
  double guide_width = 0.5;   ///< so far from it [m]
  double ridge_share = 0.2;   ///< of the samples, from the narrow cells of the fill
};

/// OMPL's FMT* from start to goal, both free, on samples from the cells of a flood fill. Empty when
/// the samples do not connect them. Depends on the arguments alone.
Polyline fast_marching_tree(const ClearanceMap& map, const FloodFill& fill,
                            const Eigen::Vector2d& start, const Eigen::Vector2d& goal,
                            const FastMarchingTreeParams& params, std::uint32_t seed);

}  // namespace swiftlet
