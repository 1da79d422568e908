// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/seen_space.hpp"

#include <cstdlib>

namespace swiftlet {
namespace {

/// Log-odds in thousandths of a cell that a few beams have passed and none has hit. Beams along a
/// wall pass cells of it, too, now and then.
constexpr std::int16_t kOpen = -800;

}  // namespace

SeenSpace::SeenSpace(const OccupancyGrid& grid)
    : width_(grid.width()),
      height_(grid.height()),
      resolution_(grid.resolution()),
      looks_(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_ + 2),
             Look::kUnseen) {
  std::size_t from = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::int16_t evidence = grid.evidence()[from++];
      if (evidence == OccupancyGrid::kNoEvidence) continue;
      looks_[index({x, y})] = evidence <= kOpen ? Look::kOpen : Look::kClosed;
    }
  }
}

bool SeenSpace::sees(Cell from, Cell to) const {
  // In whole numbers; where the line meets a corner, it goes on diagonally.
  const int dx = std::abs(to.x - from.x), dy = std::abs(to.y - from.y);
  const int step_x = to.x > from.x ? 1 : -1, step_y = to.y > from.y ? 1 : -1;
  Cell at = from;
  int error = dx - dy;
  while (at != to) {
    if (!is_open(at)) return false;
    if (error == 0) {
      at.x += step_x;
      at.y += step_y;
      error += 2 * (dx - dy);
    } else if (error > 0) {
      at.x += step_x;
      error -= 2 * dy;
    } else {
      at.y += step_y;
      error += 2 * dx;
    }
  }
  return true;
}

}  // namespace swiftlet
