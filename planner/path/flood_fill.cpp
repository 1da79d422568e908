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
constexpr double kFar = 1e9;  // and no more, beyond the map

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
  const bool enters = !map.contains(start), leaves = !map.contains(goal);
  if ((enters || leaves) && !map.open()) return fill;
  if (!enters && !map.is_free(start)) return fill;
  const std::size_t cells = map.field().values().size();
  std::vector<std::uint32_t> cost(cells, UINT32_MAX);
  std::vector<std::uint8_t> came_by(cells, kNoMove);
  std::vector<std::uint8_t> done(cells, 0);

  const double max_density = 1.0 + map.cost().clearance_weight + map.cost().unknown_weight;
  const double unit = std::min(kUnit, kMaxStep / (kDiagonal * max_density));
  const auto straight = static_cast<std::uint32_t>(std::max(1.0, std::round(unit)));
  const auto diagonal = static_cast<std::uint32_t>(std::max(1.0, std::round(unit * kDiagonal)));
  const auto steps = [&](Cell a, Cell b) {
    const auto dx = static_cast<std::uint32_t>(std::abs(a.x - b.x));
    const auto dy = static_cast<std::uint32_t>(std::abs(a.y - b.y));
    return straight * (std::max(dx, dy) - std::min(dx, dy)) + diagonal * std::min(dx, dy);
  };
  // No way to the goal costs less than in eight directions at density 1.
  const auto to_go = [&](Cell cell) { return steps(cell, goal); };
  const auto beyond = [&](Cell a, Cell b) {
    const double cost_there = steps(a, b) * (1.0 + map.cost().unknown_weight);
    return static_cast<std::uint32_t>(std::min(std::round(cost_there), kFar));
  };
  // An edge cell in sight of a place outside.
  const auto faces = [&](Cell cell, Cell place) {
    return (cell.x == 0 && place.x < 0) || (cell.x + 1 == map.width() && place.x >= map.width()) ||
           (cell.y == 0 && place.y < 0) || (cell.y + 1 == map.height() && place.y >= map.height());
  };
  struct Entry {
    std::uint32_t level, cost;
    Cell cell;
  };
  std::vector<Entry> entries;
  const auto enter = [&](Cell cell) {
    if (!faces(cell, start) || !map.is_free(cell)) return;
    const std::uint32_t way = beyond(start, cell);
    entries.push_back({way + to_go(cell), way, cell});
  };
  if (enters) {
    for (int x = 0; x < map.width(); ++x) {
      enter({x, 0});
      enter({x, map.height() - 1});
    }
    for (int y = 0; y < map.height(); ++y) {
      enter({0, y});
      enter({map.width() - 1, y});
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.level < b.level; });
  } else {
    entries.push_back({to_go(start), 0, start});
  }
  if (entries.empty()) return fill;

  const auto dearest = static_cast<std::size_t>(std::ceil(unit * kDiagonal * max_density));
  const std::size_t buckets = dearest + 2 * diagonal + 2;
  std::vector<std::vector<Cell>> queue(buckets);
  std::uint32_t best = UINT32_MAX;  // of all ways to the goal
  Cell end = goal;                  // of that way, in the map
  const auto arrive = [&](Cell cell, std::uint32_t whole) {
    if (whole >= best) return;
    best = whole;
    end = cell;
  };
  std::size_t waiting = 0, entered = 0;
  for (std::uint32_t level = entries[0].level; waiting > 0 || entered < entries.size(); ++level) {
    if (best < UINT32_MAX && level > best + best / 10) break;
    std::vector<Cell>& bucket = queue[level % buckets];
    for (; entered < entries.size() && entries[entered].level == level; ++entered) {
      const Entry& entry = entries[entered];
      if (entry.cost >= cost[map.index(entry.cell)]) continue;
      cost[map.index(entry.cell)] = entry.cost;
      came_by[map.index(entry.cell)] = kNoMove;
      bucket.push_back(entry.cell);
      ++waiting;
    }
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const Cell cell = bucket[i];
      --waiting;
      const std::size_t at = map.index(cell);
      if (done[at] != 0) continue;
      done[at] = 1;
      fill.reached.push_back(cell);
      if (is_narrow(map, cell)) fill.narrow.push_back(cell);
      if (cell == goal) arrive(cell, cost[at]);
      if (leaves && faces(cell, goal)) arrive(cell, cost[at] + beyond(cell, goal));
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
  if (best < UINT32_MAX) {
    for (Cell cell = end; fill.to_goal.size() <= cells;) {
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
