// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Ways and frontiers against what a person or a slower program says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planner/exploration/cell_ways.hpp"
#include "planner/exploration/frontiers.hpp"

namespace swiftlet {
namespace {

/// Rows from the top: '.' free, '#' occupied, ' ' unseen.
OccupancyGrid drawn(const std::vector<std::string>& rows) {
  OccupancyGrid grid({}, {0.0, 0.0}, static_cast<int>(rows[0].size()),
                     static_cast<int>(rows.size()));
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const char c =
          rows[static_cast<std::size_t>(grid.height() - 1 - y)][static_cast<std::size_t>(x)];
      if (c == '.') grid.set_state({x, y}, CellState::kFree);
      if (c == '#') grid.set_state({x, y}, CellState::kOccupied);
    }
  }
  return grid;
}

DistanceField field_of(const OccupancyGrid& grid) {
  DistanceField::Params params;
  params.unknown_is_obstacle = true;
  params.max_distance = 1.0;
  return {grid, params};
}

TEST(CellWays, AreTheShortestInEightDirectionsAndCutNoCorner) {
  const OccupancyGrid grid = drawn({"......", ".####.", "....#.", ".##.#.", "..#..."});
  const CellWays ways(StandingSpace(field_of(grid), 0.0), {0, 0});
  const double r = grid.resolution();
  EXPECT_DOUBLE_EQ(ways.length({0, 0}), 0.0);
  EXPECT_NEAR(ways.length({0, 4}), 4 * r, 1e-9);
  // (1, 2) to (3, 0): around the corner of the wall, since a disc would touch it.
  EXPECT_NEAR(ways.length({3, 0}), 2 * r + 3 * r + 2 * r, 1e-9);
  EXPECT_EQ(ways.reached().front(), (Cell{0, 0}));
  EXPECT_FALSE(ways.reaches({2, 0}));
  EXPECT_TRUE(std::isinf(ways.length({2, 0})));
  EXPECT_TRUE(std::is_sorted(ways.reached().begin(), ways.reached().end(),
                             [&](Cell a, Cell b) { return ways.length(a) < ways.length(b); }));
}

TEST(CellWays, AreAtMostEightPercentLongerThanTheLineWhereNothingIsInTheWay) {
  OccupancyGrid grid({}, {0.0, 0.0}, 60, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) grid.set_state({x, y}, CellState::kFree);
  }
  const CellWays ways(StandingSpace(field_of(grid), 0.0), {30, 30});
  ASSERT_EQ(ways.reached().size(), 3600U);
  for (const Cell cell : ways.reached()) {
    const double line = grid.resolution() * std::hypot(cell.x - 30, cell.y - 30);
    EXPECT_GE(ways.length(cell), line * 0.999);
    EXPECT_LE(ways.length(cell), line * 1.09);
  }
}

TEST(CellWays, LeadThroughNoGapThatIsTooNarrow) {
  OccupancyGrid grid({}, {0.0, 0.0}, 60, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      const bool wall = x == 30 && (y < 12 || y >= 26);  // a gap of 0.70 m
      grid.set_state({x, y}, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  const DistanceField field = field_of(grid);
  EXPECT_TRUE(CellWays(StandingSpace(field, 0.30), {8, 20}).reaches({50, 20}));
  EXPECT_FALSE(CellWays(StandingSpace(field, 0.40), {8, 20}).reaches({50, 20}));
  EXPECT_TRUE(CellWays(StandingSpace(field, 0.40), {30, 0}).reached().empty()) << "in the wall";
  const StandingSpace space(field, 0.30);
  const auto beside = space.nearest({29, 2});
  ASSERT_TRUE(beside);
  EXPECT_TRUE(space.has(*beside));
  EXPECT_GE(field.distance(*beside), 0.30);
  EXPECT_FALSE(space.nearest({29, 2}, 0.05));
}

TEST(Frontiers, AreWhereTheFreeSpaceEndsWithoutAWall) {
  const OccupancyGrid grid =
      drawn({"########", "#....   ", "#....   ", "#....   ", "#....###", "##.#####", "        "});
  const SeenSpace space(grid);
  const std::vector<std::uint8_t> all(56, 1);
  const auto frontiers = find_frontiers(space, all, 10.0);
  ASSERT_EQ(frontiers.size(), 2U);
  EXPECT_THAT(frontiers[0].cells, testing::ElementsAre(Cell{2, 0}));
  EXPECT_THAT(frontiers[1].cells,
              testing::UnorderedElementsAre(Cell{5, 3}, Cell{5, 4}, Cell{5, 5}));
  const double cell = grid.resolution() * grid.resolution();
  EXPECT_NEAR(frontiers[0].area, 8 * cell, 1e-12);
  EXPECT_NEAR(frontiers[1].area, 9 * cell, 1e-12);
  // What does not matter is not there.
  std::vector<std::uint8_t> some = all;
  some[2] = 0;
  EXPECT_EQ(find_frontiers(space, some, 10.0).size(), 1U);
  // A long one is several.
  EXPECT_EQ(find_frontiers(space, all, 0.5 * grid.resolution()).size(), 3U);
}

TEST(SeenSpace, SightEndsAtWhatIsNotOpen) {
  const OccupancyGrid grid = drawn({".....", "..#..", "....."});
  const SeenSpace space(grid);
  EXPECT_TRUE(space.sees({0, 0}, {4, 0}));
  EXPECT_FALSE(space.sees({0, 1}, {4, 1}));
  EXPECT_TRUE(space.sees({0, 1}, {2, 1})) << "the obstacle itself is seen";
  EXPECT_FALSE(space.sees({1, 0}, {3, 2}));
  EXPECT_TRUE(space.is_unseen({-1, 0}));
}

}  // namespace
}  // namespace swiftlet
