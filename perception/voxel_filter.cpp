// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel_filter.hpp"

#include <cmath>

namespace swiftlet {
namespace {

/// Cubes along an axis to either side of the origin: 21 bits an axis fit into a key.
constexpr std::int64_t kReach = 1 << 20;

}  // namespace

bool VoxelFilter::add(const Eigen::Vector3d& point) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::floor(point[axis] / edge_);
    if (!(place >= -kReach && place < kReach)) return false;
    key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(place) + kReach);
  }
  const auto found = index_.find(key);
  if (found == index_.end()) {
    if (cubes_.size() >= kMostPoints) return false;
    index_.emplace(key, static_cast<std::uint32_t>(cubes_.size()));
    cubes_.push_back({point, 1.0});
    return true;
  }
  Cube& cube = cubes_[found->second];
  cube.sum += point;
  cube.count += 1.0;
  return true;
}

std::vector<Eigen::Vector3d> VoxelFilter::points() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(cubes_.size());
  for (const Cube& cube : cubes_) points.emplace_back(cube.sum / cube.count);
  return points;
}

}  // namespace swiftlet
