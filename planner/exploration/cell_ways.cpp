// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/cell_ways.hpp"

#include <array>
#include <cstddef>
#include <limits>

namespace swiftlet {
namespace {

// Lengths of a straight and of a diagonal step in whole numbers: 1.41666 for the root of two.
constexpr std::uint32_t kStraight = 12;
constexpr std::uint32_t kDiagonal = 17;

}  // namespace

StandingSpace::StandingSpace(const DistanceField& field, double clearance)
    : width_(field.width()),
      height_(field.height()),
      resolution_(field.resolution()),
      free_(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_ + 2), 0) {
  const double least = clearance + 0.5 * resolution_;
  auto distance = field.values().begin();
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) free_[index({x, y})] = *distance++ >= least ? 1 : 0;
  }
}

std::optional<Cell> StandingSpace::nearest(Cell place, double reach) const {
  const int cells = static_cast<int>(reach / resolution_);
  std::optional<Cell> nearest;
  int least = cells * cells + 1;
  for (int dy = -cells; dy <= cells; ++dy) {
    for (int dx = -cells; dx <= cells; ++dx) {
      const Cell cell{place.x + dx, place.y + dy};
      if (dx * dx + dy * dy >= least || !has(cell)) continue;
      least = dx * dx + dy * dy;
      nearest = cell;
    }
  }
  return nearest;
}

CellWays::CellWays(const StandingSpace& space, Cell from)
    : stride_(space.stride()),
      unit_(space.resolution() / kStraight),
      steps_(space.free_.size(), kUnreached) {
  if (!space.has(from)) return;
  struct Move {
    std::ptrdiff_t by;
    std::ptrdiff_t beside, besides;  // common neighbours, of a diagonal step
    std::uint32_t length;
  };
  const std::ptrdiff_t up = stride_;
  const std::array<Move, 8> moves{{{1, 0, 0, kStraight},
                                   {-1, 0, 0, kStraight},
                                   {up, 0, 0, kStraight},
                                   {-up, 0, 0, kStraight},
                                   {up + 1, up, 1, kDiagonal},
                                   {up - 1, up, -1, kDiagonal},
                                   {-up + 1, -up, 1, kDiagonal},
                                   {-up - 1, -up, -1, kDiagonal}}};
  const std::uint8_t* free = space.free_.data();
  std::array<std::vector<std::ptrdiff_t>, kDiagonal + 1> queue;
  const auto start = static_cast<std::ptrdiff_t>(index(from));
  steps_[index(from)] = 0;
  queue[0].push_back(start);
  std::size_t waiting = 1;
  for (std::uint32_t level = 0; waiting > 0; ++level) {
    std::vector<std::ptrdiff_t>& bucket = queue[level % queue.size()];
    waiting -= bucket.size();
    for (const std::ptrdiff_t at : bucket) {
      if (steps_[static_cast<std::size_t>(at)] != level) continue;  // a shorter way was found
      reached_.push_back({static_cast<int>(at % up) - 1, static_cast<int>(at / up) - 1});
      for (const Move& move : moves) {
        const std::ptrdiff_t next = at + move.by;
        if (free[next] == 0) continue;
        std::uint32_t& known = steps_[static_cast<std::size_t>(next)];
        if (known <= level + move.length) continue;
        if (free[at + move.beside] == 0 || free[at + move.besides] == 0) continue;
        known = level + move.length;
        queue[known % queue.size()].push_back(next);
        ++waiting;
      }
    }
    bucket.clear();
  }
}

double CellWays::length(Cell to) const {
  const std::uint32_t steps = steps_[index(to)];
  return steps == kUnreached ? std::numeric_limits<double>::infinity() : unit_ * steps;
}

}  // namespace swiftlet
