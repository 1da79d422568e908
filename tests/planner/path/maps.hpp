// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "perception/occupancy_grid.hpp"
#include "planner/path/clearance_map.hpp"

namespace swiftlet::test {

/// Sets all cells with their centre in a box.
inline void paint(OccupancyGrid& grid, double x0, double y0, double x1, double y1,
                  CellState state) {
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const Eigen::Vector2d p = grid.center_of({x, y});
      if (p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1) grid.set_state({x, y}, state);
    }
  }
}

inline OccupancyGrid hall(double width, double height) {
  OccupancyGrid grid({}, {0, 0}, static_cast<int>(width / 0.05 + 0.5),
                     static_cast<int>(height / 0.05 + 0.5));
  paint(grid, 0, 0, width, height, CellState::kOccupied);
  paint(grid, 0.1, 0.1, width - 0.1, height - 0.1, CellState::kFree);
  return grid;
}

/// 15 x 10 m: two rooms below, a corridor, one room above, doorways of 0.9 m centred at x = 2.45,
/// 8.45 (y = 4) and 12.45 (y = 6), furniture.
inline OccupancyGrid office() {
  OccupancyGrid grid = hall(15.2, 10.2);
  const CellState wall = CellState::kOccupied, air = CellState::kFree;
  paint(grid, 0, 4, 15.2, 4.1, wall);
  paint(grid, 5, 0, 5.1, 4, wall);
  paint(grid, 0, 6, 15.2, 6.1, wall);
  paint(grid, 2, 3.9, 2.9, 4.2, air);
  paint(grid, 8, 3.9, 8.9, 4.2, air);
  paint(grid, 12, 5.9, 12.9, 6.2, air);
  paint(grid, 10.5, 1, 12, 2.5, wall);
  paint(grid, 7, 7.5, 9, 8.5, wall);
  return grid;
}

/// A walled field with some random boxes and walls, parts of it unknown.
inline OccupancyGrid random_field(std::mt19937& random, double size) {
  OccupancyGrid grid = hall(size, size);
  std::uniform_real_distribution<double> u(0.0, size), edge(0.1, 0.3 * size), share(0.0, 1.0);
  if (share(random) < 0.5) {
    // A wall right across, with a doorway of any width.
    const double x = u(random), y = u(random);
    paint(grid, x, 0, x + 0.15, size, CellState::kOccupied);
    paint(grid, x - 0.05, y, x + 0.2, y + 1.5 * share(random), CellState::kFree);
  }
  const int boxes = static_cast<int>(random() % 9);
  if (share(random) < 0.3) {
    const double x = u(random), y = u(random);
    paint(grid, x, y, x + edge(random), y + edge(random), CellState::kUnknown);
  }
  for (int i = 0; i < boxes; ++i) {
    const double x = u(random), y = u(random);
    const bool thin = share(random) < 0.5;
    paint(grid, x, y, x + edge(random), y + (thin ? 0.1 : edge(random)), CellState::kOccupied);
  }
  return grid;
}

/// Distance from a point to the nearest occupied square, over all of them.
inline double true_clearance(const OccupancyGrid& grid, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  const double half = 0.5 * grid.resolution();
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid.state({x, y}) != CellState::kOccupied) continue;
      const Eigen::Vector2d d = (grid.center_of({x, y}) - p).cwiseAbs();
      const Eigen::Vector2d outside = (d - Eigen::Vector2d(half, half)).cwiseMax(0.0);
      nearest = std::min(nearest, outside.norm());
    }
  }
  return nearest;
}

/// Shortest way between two cells over centres that keep a clearance (all pairs of clearances by
/// brute force would be too slow: the field is tested on its own), with 16 directions: at most 2.7
/// % longer than the shortest at all. Infinite where there is none.
inline double dijkstra_length(const ClearanceMap& map, Cell start, Cell goal, double clearance) {
  const auto open = [&](int x, int y) {
    return map.contains(Cell{x, y}) && map.clearance(Cell{x, y}) >= clearance;
  };
  if (!open(start.x, start.y) || !open(goal.x, goal.y)) {
    return std::numeric_limits<double>::infinity();
  }
  std::vector<double> best(map.field().values().size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  best[map.index(start)] = 0.0;
  queue.push({0.0, {start.x, start.y}});
  while (!queue.empty()) {
    const auto [cost, cell] = queue.top();
    queue.pop();
    const auto [x, y] = cell;
    if (cost > best[map.index({x, y})]) continue;
    if (goal == Cell{x, y}) return cost * map.resolution();
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int norm = dx * dx + dy * dy;
        if (norm != 1 && norm != 2 && norm != 5) continue;
        if (!open(x + dx, y + dy)) continue;
        // Everything in the box of the step must be open.
        bool clear = true;
        for (int by = std::min(0, dy); by <= std::max(0, dy); ++by) {
          for (int bx = std::min(0, dx); bx <= std::max(0, dx); ++bx) {
            clear = clear && open(x + bx, y + by);
          }
        }
        if (!clear) continue;
        const double next = cost + std::sqrt(norm);
        double& known = best[map.index({x + dx, y + dy})];
        if (next < known) {
          known = next;
          queue.push({next, {x + dx, y + dy}});
        }
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace swiftlet::test
