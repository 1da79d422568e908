// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "perception/voxel_grid.hpp"
#include "planner/any_angle/taut_line.hpp"

namespace swiftlet {

enum class OmplPeer {
  /// RRTConnect and OMPL's simplification of its path. What OMPL takes by itself in the plane,
  /// LBKPIECE1, ends in a failed assertion of its own in Debian's 1.5.2.
  kRrtConnect,
  kBitStar,  ///< BIT*, which goes on to shorten its path until the time is over
};

/// A path from the middle of `start` to that of `goal` by a planner of OMPL, with its defaults but
/// for the check of motions, which is exact; empty where it finds none within `limit_s`. In the
/// plane where the grid has a depth of 1.
SpaceLine plan_with_ompl(OmplPeer peer, const VoxelGrid& grid, Voxel start, Voxel goal,
                         double limit_s);

/// Makes what OMPL draws depend on `seed`; to be called before its first planner.
void seed_ompl(std::uint32_t seed);

}  // namespace swiftlet
