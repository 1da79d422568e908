// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "perception/voxel_grid.hpp"

namespace swiftlet {

/// Checks of a ball at random places, by us and by a peer.
struct CollisionComparison {
  int checks = 0;
  int contacts = 0;            ///< by the peer
  int missed = 0;              ///< free by us, a contact by the peer
  int needless = 0;            ///< a contact by us alone
  double seconds = 0.0;        ///< of all checks, ours
  double peer_seconds = 0.0;   ///< of the same, the peer's
  double prepare_seconds = 0;  ///< to make the grid ready for the ball, once a map
};

/// A ball of `radius` [voxels] at `checks` places within the grid: grid.grown(radius) beside FCL
/// (Pan, Chitta and Manocha 2012) with an octree of OctoMap.
CollisionComparison compare_with_fcl(const VoxelGrid& grid, double radius, int checks,
                                     std::uint32_t seed);

}  // namespace swiftlet
