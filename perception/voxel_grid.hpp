// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Index of a cube of a voxel grid.
struct Voxel {
  int x = 0;
  int y = 0;
  int z = 0;
  bool operator==(const Voxel& other) const { return x == other.x && y == other.y && z == other.z; }
  bool operator!=(const Voxel& other) const { return !(*this == other); }
};

/// Which unit cubes of a box are blocked; everything outside of the box is. Lengths are counted in
/// cubes: voxel (x, y, z) is the cube from (x, y, z) to (x + 1, y + 1, z + 1). A map of the plane
/// is a box of depth 1.
///
/// Stored with a blocked layer around it, so that the neighbours of every voxel can be looked at.
class VoxelGrid {
 public:
  static constexpr std::int64_t kMaxVoxels = 500'000'000;

  VoxelGrid() = default;
  /// Nothing in it is blocked. Fails where a size is less than 1 or the box is beyond kMaxVoxels.
  static Result<VoxelGrid> make(int width, int depth, int height);

  int size_x() const { return size_.x; }
  int size_y() const { return size_.y; }
  int size_z() const { return size_.z; }
  bool empty() const { return words_.empty(); }
  bool contains(Voxel voxel) const {
    return voxel.x >= 0 && voxel.y >= 0 && voxel.z >= 0 && voxel.x < size_.x && voxel.y < size_.y &&
           voxel.z < size_.z;
  }

  /// `voxel` must be inside.
  void set_blocked(Voxel voxel, bool blocked = true) { set(index(voxel), blocked); }
  /// `voxel` must be inside, or in the layer around the box.
  bool blocked(Voxel voxel) const { return blocked(index(voxel)); }
  bool blocked(std::size_t index) const { return (words_[index / 64] >> index % 64 & 1U) != 0; }

  /// Where a voxel is in the memory of the grid, the layer around it included. Neighbours along an
  /// axis are as many places apart as `stride` of that axis says.
  std::size_t index(Voxel voxel) const {
    return static_cast<std::size_t>((voxel.x + 1) + (voxel.y + 1) * stride_.y +
                                    (voxel.z + 1) * stride_.z);
  }
  Voxel voxel_at(std::size_t index) const;
  std::size_t stored() const { return stored_; }  ///< voxels, the layer included
  int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? stride_.y : stride_.z; }

  /// The grid as the centre of a ball of `radius` [voxels] sees it: blocked is every voxel that has
  /// a place from which the ball would touch a blocked one. Conservative: a ball whose centre is
  /// anywhere in a free voxel touches nothing.
  VoxelGrid grown(double radius) const;

 private:
  void set(std::size_t index, bool blocked) {
    const std::uint64_t bit = std::uint64_t{1} << index % 64;
    words_[index / 64] = blocked ? words_[index / 64] | bit : words_[index / 64] & ~bit;
  }

  Voxel size_;
  Voxel stride_;
  std::size_t stored_ = 0;
  std::vector<std::uint64_t> words_;  // a bit a voxel: a map of 500 x 500 x 30 fits into a cache
};

/// The middle of a voxel.
inline Eigen::Vector3d center_of(Voxel voxel) {
  return {voxel.x + 0.5, voxel.y + 0.5, voxel.z + 0.5};
}

/// Whether the straight line from `a` to `b` [voxels] touches no blocked cube. Exact but for
/// 1e-9 of a voxel, by which lines that pass so near are counted as touching: cubes are closed, so
/// a line through the edge or corner of a blocked one touches it.
bool line_is_free(const VoxelGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The same for the line between the middles of two voxels, both inside: exact, in whole numbers,
/// and faster.
bool sees(const VoxelGrid& grid, Voxel from, Voxel to);

}  // namespace swiftlet
