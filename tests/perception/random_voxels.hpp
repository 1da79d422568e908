// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "perception/voxel_grid.hpp"

namespace swiftlet::test {

/// A box in which every voxel is blocked with a probability.
inline VoxelGrid random_voxels(std::mt19937& random, Voxel size, double share) {
  VoxelGrid grid = VoxelGrid::make(size.x, size.y, size.z).value();
  std::bernoulli_distribution blocked(share);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) grid.set_blocked({x, y, z}, blocked(random));
    }
  }
  return grid;
}

inline Voxel random_voxel(std::mt19937& random, const VoxelGrid& grid) {
  const auto along = [&random](int size) {
    return std::uniform_int_distribution<>(0, size - 1)(random);
  };
  return {along(grid.size_x()), along(grid.size_y()), along(grid.size_z())};
}

inline Voxel random_free_voxel(std::mt19937& random, const VoxelGrid& grid) {
  for (;;) {
    const Voxel voxel = random_voxel(random, grid);
    if (!grid.blocked(voxel)) return voxel;
  }
}

}  // namespace swiftlet::test
