// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/flood_fill.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>

#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

TEST(FloodFill, EveryStepOfItsWayIsAllowed) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.5, 7.5);
  int steps = 0, diagonal = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const OccupancyGrid grid = test::random_field(random, 8.0);
    const auto map = ClearanceMap::make(grid, {});
    ASSERT_TRUE(map.ok());
    const Cell start = map->cell_of({place(random), place(random)});
    const Cell goal = map->cell_of({place(random), place(random)});
    const FloodFill fill = flood_fill(*map, start, goal);
    if (fill.to_goal.empty()) continue;
    EXPECT_EQ(fill.to_goal.front(), start);
    EXPECT_EQ(fill.to_goal.back(), goal);
    for (std::size_t i = 0; i + 1 < fill.to_goal.size(); ++i) {
      const Cell a = fill.to_goal[i], b = fill.to_goal[i + 1];
      ASSERT_EQ(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)), 1);
      // Not merely the centres: the line between them, finely.
      for (int k = 0; k <= 20; ++k) {
        const Eigen::Vector2d p =
            map->center_of(a) + (map->center_of(b) - map->center_of(a)) * (k / 20.0);
        ASSERT_GE(map->clearance_at(p), map->cost().hard_clearance() - 1e-6) << trial;
      }
      ++steps;
      diagonal += a.x != b.x && a.y != b.y;
    }
  }
  EXPECT_GT(steps, 5000);
  EXPECT_GT(diagonal, 1000);
}

TEST(FloodFill, ACornerBetweenTwoClosedCellsIsClosed) {
  // Two pillars: the free cells between them touch in a corner only, for some vehicle radius.
  OccupancyGrid grid({}, {0, 0}, 80, 80);
  test::paint(grid, 0, 0, 4, 4, CellState::kFree);
  for (int k = 0; k < 80; ++k) {
    // A diagonal wall with a gap.
    if (k < 33 || k > 46) grid.set_state({k, k}, CellState::kOccupied);
  }
  int open = 0, closed = 0;
  for (double radius = 0.40; radius < 0.55; radius += 0.002) {
    PathCost cost;
    cost.radius = radius;
    cost.margin = 0.0;
    const auto map = ClearanceMap::make(grid, cost);
    ASSERT_TRUE(map.ok());
    const FloodFill fill = flood_fill(*map, {60, 20}, {20, 60});
    ++(fill.to_goal.empty() ? closed : open);
    for (std::size_t i = 0; i + 1 < fill.to_goal.size(); ++i) {
      const Eigen::Vector2d middle =
          0.5 * (map->center_of(fill.to_goal[i]) + map->center_of(fill.to_goal[i + 1]));
      ASSERT_GE(map->clearance_at(middle), radius - 1e-6) << radius;
    }
  }
  EXPECT_GT(open, 10);
  EXPECT_GT(closed, 10);
}

TEST(FloodFill, WithoutAWayItFillsAllThatCanBeReached) {
  OccupancyGrid grid = test::office();
  test::paint(grid, 12, 5.95, 12.9, 6.1, CellState::kOccupied);
  const auto map = ClearanceMap::make(grid, {});
  ASSERT_TRUE(map.ok());
  const Cell start = map->cell_of({1, 1}), goal = map->cell_of({3, 9});
  const FloodFill fill = flood_fill(*map, start, goal);
  EXPECT_TRUE(fill.to_goal.empty());
  std::set<std::pair<int, int>> reached;
  for (const Cell cell : fill.reached) EXPECT_TRUE(reached.insert({cell.x, cell.y}).second);
  // By hand: whatever is free below the corridor's upper wall belongs to one part.
  for (int y = 0; y < map->height(); ++y) {
    for (int x = 0; x < map->width(); ++x) {
      const bool below = map->center_of({x, y}).y() < 6.0;
      EXPECT_EQ(reached.count({x, y}) == 1, below && map->is_free({x, y})) << x << " " << y;
    }
  }
}

TEST(FloodFill, LeavesAnOpenMapByTheEdgeThatFacesTheGoal) {
  OccupancyGrid grid = test::hall(6, 6);
  test::paint(grid, -1, 2, 0.15, 4, CellState::kFree);
  const auto map = ClearanceMap::make(grid, {}, {}, 1.0);
  ASSERT_TRUE(map.ok());
  const Cell start = map->cell_of({3, 3});
  const auto last = [&](Cell goal) { return flood_fill(*map, start, goal).to_goal.back(); };
  EXPECT_EQ(last({-500, start.y}), (Cell{0, start.y}));
  EXPECT_EQ(last({-500, -480}).x, 0);
  EXPECT_EQ(last({start.x, 3000}).y, map->height() - 1);
  EXPECT_EQ(last({map->width(), start.y}).x, map->width() - 1) << "around the hall";
  // And is entered by the edge that faces the start.
  const FloodFill across = flood_fill(*map, {-40, start.y}, {-40, start.y + 500});
  ASSERT_FALSE(across.to_goal.empty());
  EXPECT_EQ(across.to_goal.front().x, 0);
  const Cell first = flood_fill(*map, {900, -700}, start).to_goal.front();
  EXPECT_TRUE(first.x == map->width() - 1 || first.y == 0) << first.x << " " << first.y;
  const auto narrow = ClearanceMap::make(grid, {}, {}, 0.5);
  EXPECT_TRUE(flood_fill(*narrow, narrow->cell_of({3, 3}), {-500, 70}).to_goal.empty());
}

TEST(FloodFill, NarrowCellsLieInTheMiddleOfPassages) {
  const OccupancyGrid grid = test::office();
  const auto map = ClearanceMap::make(grid, {});
  const FloodFill fill = flood_fill(*map, map->cell_of({1, 1}), map->cell_of({3, 9}));
  int in_doorways = 0;
  for (const Cell cell : fill.narrow) {
    const Eigen::Vector2d p = map->center_of(cell);
    EXPECT_LT(map->clearance(cell), map->cost().preferred_clearance);
    if (p.y() > 4.0 && p.y() < 4.1 && p.x() > 2.0 && p.x() < 2.9) {
      EXPECT_NEAR(p.x(), 2.45, 0.051);
      ++in_doorways;
    }
  }
  EXPECT_GE(in_doorways, 2);
}

}  // namespace
}  // namespace swiftlet
