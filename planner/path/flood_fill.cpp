// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/flood_fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace swiftlet {
namespace {

// Cost of a metre of density 1 along an axis, per cell, in whole numbers.
constexpr double kUnit = 10.0;
constexpr double kMaxStep = 4000.0;

struct Move {
  int x, y;
  double length;
};
constexpr double kDiagonal = 1.4142135623730951;
constexpr std::array<Move, 8> kMoves{{{1, 0, 1.0},
                                      {-1, 0, 1.0},
                                      {0, 1, 1.0},
                                      {0, -1, 1.0},
                                      {1, 1, kDiagonal},
                                      {1, -1, kDiagonal},
                                      {-1, 1, kDiagonal},
                                      {-1, -1, kDiagonal}}};
constexpr std::uint8_t kNoMove = 255;

/// Not lower than its two neighbours along one axis and nearer to an obstacle than preferred: on
/// the middle line of a passage.
bool is_narrow(const ClearanceMap& map, Cell cell) {
  const double here = map.clearance(cell);
  if (here >= map.cost().preferred_clearance) return false;
  const auto ridge = [&](int dx, int dy) {
    const Cell a{cell.x + dx, cell.y + dy}, b{cell.x - dx, cell.y - dy};
    if (!map.contains(a) || !map.contains(b)) return false;
    const double left = map.clearance(a), right = map.clearance(b);
    return here >= left && here >= right && (here > left || here > right);
  };
  return ridge(1, 0) || ridge(0, 1);
}

}  // namespace

FloodFill flood_fill(const ClearanceMap& map, Cell start, Cell goal) {
  FloodFill fill;
  if (!map.contains(start) || !map.contains(goal) || !map.is_free(start)) return fill;
  const std::size_t cells = map.field().values().size();
  std::vector<std::uint32_t> cost(cells, UINT32_MAX);
  std::vector<std::uint8_t> came_by(cells, kNoMove);
  std::vector<std::uint8_t> done(cells, 0);

  const double max_density = 1.0 + map.cost().clearance_weight + map.cost().unknown_weight;
  const double unit = std::min(kUnit, kMaxStep / (kDiagonal * max_density));
  const auto straight = static_cast<std::uint32_t>(std::max(1.0, std::round(unit)));
  const auto diagonal = static_cast<std::uint32_t>(std::max(1.0, std::round(unit * kDiagonal)));
  // No way to the goal costs less than in eight directions at density 1.
  const auto to_go = [&](Cell cell) {
    const auto dx = static_cast<std::uint32_t>(std::abs(cell.x - goal.x));
    const auto dy = static_cast<std::uint32_t>(std::abs(cell.y - goal.y));
    return straight * (std::max(dx, dy) - std::min(dx, dy)) + diagonal * std::min(dx, dy);
  };
  const auto dearest = static_cast<std::size_t>(std::ceil(unit * kDiagonal * max_density));
  const std::size_t buckets = dearest + 2 * diagonal + 2;
  std::vector<std::vector<Cell>> queue(buckets);
  cost[map.index(start)] = 0;
  const std::uint32_t first = to_go(start);
  queue[first % buckets].push_back(start);
  std::size_t waiting = 1;
  std::uint64_t last = UINT32_MAX;
  for (std::uint32_t level = first; waiting > 0 && level <= last; ++level) {
    std::vector<Cell>& bucket = queue[level % buckets];
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const Cell cell = bucket[i];
      --waiting;
      const std::size_t at = map.index(cell);
      if (done[at] != 0) continue;
      done[at] = 1;
      fill.reached.push_back(cell);
      if (is_narrow(map, cell)) fill.narrow.push_back(cell);
      if (cell == goal) last = level + level / 10;
      for (std::uint8_t m = 0; m < kMoves.size(); ++m) {
        const Move& move = kMoves[m];
        const Cell next{cell.x + move.x, cell.y + move.y};
        if (!map.contains(next) || !map.is_free(next) || done[map.index(next)] != 0) continue;
        if (m >= 4 && !(map.is_free({next.x, cell.y}) && map.is_free({cell.x, next.y}))) continue;
        const double density = 0.5 * (map.density(cell) + map.density(next));
        const auto step =
            static_cast<std::uint32_t>(std::max(1.0, std::round(unit * move.length * density)));
        const std::uint32_t through = cost[at] + step;
        if (through < cost[map.index(next)]) {
          cost[map.index(next)] = through;
          came_by[map.index(next)] = m;
          queue[(through + to_go(next)) % buckets].push_back(next);
          ++waiting;
        }
      }
    }
    bucket.clear();
  }
  if (done[map.index(goal)] != 0) {
    for (Cell cell = goal; fill.to_goal.size() <= cells;) {
      fill.to_goal.push_back(cell);
      const std::uint8_t m = came_by[map.index(cell)];
      if (m == kNoMove) break;
      cell = {cell.x - kMoves[m].x, cell.y - kMoves[m].y};
    }
    std::reverse(fill.to_goal.begin(), fill.to_goal.end());
  }
  return fill;
}

}  // namespace swiftlet
