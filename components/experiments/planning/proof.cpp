// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/proof.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

constexpr double kTouch = 1e-10;  // [voxels]

/// Whether the segment from a to b and the cube around `center` have a point in common.
bool touches(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& center) {
  constexpr double kHalf = 0.5 + kTouch;
  const Eigen::Vector3d middle = 0.5 * (a + b) - center, half = 0.5 * (b - a);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(middle[i]) > kHalf + std::abs(half[i])) return false;
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = half.cross(Eigen::Vector3d::Unit(i));
    if (std::abs(middle.dot(axis)) > kHalf * axis.lpNorm<1>()) return false;
  }
  return true;
}

bool segment_is_free(const VoxelGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Array3d size(grid.size_x(), grid.size_y(), grid.size_z());
  const Eigen::Array3d low = a.array().min(b.array()), high = a.array().max(b.array());
  if (!((low > kTouch).all() && (high < size - kTouch).all())) return false;
  const Eigen::Array3i first = (low - kTouch).floor().cast<int>(),
                       last = (high + kTouch).floor().cast<int>();
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const Voxel voxel{x, y, z};
        if (grid.blocked(voxel) && touches(a, b, center_of(voxel))) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool proven_free(const VoxelGrid& grid, const SpaceLine& line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (!segment_is_free(grid, line[i - 1], line[i])) return false;
  }
  return !line.empty();
}

}  // namespace swiftlet
