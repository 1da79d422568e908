// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace swiftlet {

/// Thins a cloud: one point for each cube of space, the mean of all that were in it. Its memory is
/// bounded.
class VoxelFilter {
 public:
  static constexpr std::size_t kMostPoints = 5'000'000;

  /// `edge` of a cube [m], above 0.
  explicit VoxelFilter(double edge) : edge_(edge) {}

  /// False where it is left out: not finite, a million cubes or more away from the origin, or in a
  /// new cube when there are kMostPoints.
  bool add(const Eigen::Vector3d& point);

  std::size_t size() const { return cubes_.size(); }
  /// In the order in which their cubes were first met [m].
  std::vector<Eigen::Vector3d> points() const;

 private:
  struct Cube {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
  };
  double edge_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;  // of a cube, by where it is
  std::vector<Cube> cubes_;
};

}  // namespace swiftlet
