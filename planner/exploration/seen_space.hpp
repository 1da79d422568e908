// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// Which cells of a map have been looked at: unseen where no beam has been, open where beams mostly
/// went through. Unlike the states of the map, a cell of which two beams say opposite things is
/// not unseen: there is nothing new to be found in it.
class SeenSpace {
 public:
  explicit SeenSpace(const OccupancyGrid& grid);

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }

  /// Inside of the map and of a rim of one cell around it, which is unseen.
  bool contains(Cell cell) const {
    return cell.x >= -1 && cell.y >= -1 && cell.x <= width_ && cell.y <= height_;
  }
  bool is_unseen(Cell cell) const { return looks_[index(cell)] == Look::kUnseen; }
  bool is_open(Cell cell) const { return looks_[index(cell)] == Look::kOpen; }

  /// Whether nothing but open cells lies between the middles of two cells; the last one is not
  /// looked at.
  bool sees(Cell from, Cell to) const;

 private:
  enum class Look : std::uint8_t { kUnseen, kOpen, kClosed };
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y + 1) * static_cast<std::size_t>(width_ + 2) +
           static_cast<std::size_t>(cell.x + 1);
  }

  int width_ = 0;
  int height_ = 0;
  double resolution_ = 1.0;
  std::vector<Look> looks_;
};

}  // namespace swiftlet
