// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "perception/voxel_grid.hpp"
#include "planner/any_angle/taut_line.hpp"

namespace swiftlet {

/// Whether a line touches no blocked voxel, by means that share nothing with those that plan: each
/// segment against each blocked voxel in its box, separated by an axis or not (Gottschalk's
/// separating axes). Nearer than 1e-10 of a voxel is touching; the outside is blocked.
bool proven_free(const VoxelGrid& grid, const SpaceLine& line);

}  // namespace swiftlet
