// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "perception/voxel_grid.hpp"
#include "planner/any_angle/stop.hpp"

namespace swiftlet {

/// A line through space [voxels].
using SpaceLine = std::vector<Eigen::Vector3d>;

double length_of(const SpaceLine& line);

/// Whether no part of the line touches a blocked voxel.
bool line_is_free(const VoxelGrid& grid, const SpaceLine& line);

/// Pulls a free line taut between its ends: leaves out the points it can do without, then moves
/// each of the others to where the line is shorter, by a step that is halved down to `finest`
/// [voxels]; again, until a round gains less than a ten-thousandth, or `stop` says so. The line
/// stays free, and never gets longer.
SpaceLine pull_taut(const VoxelGrid& grid, SpaceLine line, const Stop& stop,
                    double finest = 1.0 / 64.0);

}  // namespace swiftlet
