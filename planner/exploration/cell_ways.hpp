// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "perception/distance_field.hpp"

namespace swiftlet {

/// Where a disc may stand: the obstacles of a distance field are at least `clearance` [m] from the
/// middle of the cell, however they lie in their own cells.
class StandingSpace {
 public:
  StandingSpace(const DistanceField& field, double clearance);

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }
  /// False outside, too.
  bool has(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_ &&
           free_[index(cell)] != 0;
  }
  /// The nearest cell to a place that the disc may stand on, for a vehicle that is a little too
  /// near to something; nothing where there is none within `reach` [m].
  std::optional<Cell> nearest(Cell place, double reach = 0.6) const;

 private:
  friend class CellWays;
  /// Cells lie in a rim, so that their neighbours need no look at the edges.
  int stride() const { return width_ + 2; }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y + 1) * static_cast<std::size_t>(stride()) +
           static_cast<std::size_t>(cell.x + 1);
  }

  int width_;
  int height_;
  double resolution_;
  std::vector<std::uint8_t> free_;
};

/// Lengths of the shortest ways of a disc from one cell to all others, in steps to the eight
/// neighbours (Dial's algorithm): up to 8 % more than a straight line. Between two cells that touch
/// in a corner only, the way is open where the disc may stand on their two common neighbours, too.
class CellWays {
 public:
  CellWays(const StandingSpace& space, Cell from);

  /// [m]; infinite where no way leads. The cell must be in the space.
  double length(Cell to) const;
  bool reaches(Cell to) const { return steps_[index(to)] != kUnreached; }
  /// All that can be reached, the nearest first.
  const std::vector<Cell>& reached() const { return reached_; }

 private:
  static constexpr std::uint32_t kUnreached = UINT32_MAX;
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y + 1) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(cell.x + 1);
  }

  int stride_;
  double unit_;  // [m] a straight step, over kStraight
  std::vector<std::uint32_t> steps_;
  std::vector<Cell> reached_;
};

}  // namespace swiftlet
