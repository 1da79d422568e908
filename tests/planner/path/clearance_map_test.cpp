// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/clearance_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

TEST(ClearanceMap, ClearanceIsTheDistanceToTheFaceOfObstacles) {
  std::mt19937 random(1);
  const OccupancyGrid grid = test::office();
  const auto map = ClearanceMap::make(grid, {});
  ASSERT_TRUE(map.ok());
  std::uniform_real_distribution<double> x(0.3, 14.9), y(0.3, 9.9);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d p(x(random), y(random));
    const double truth = std::min(test::true_clearance(grid, p), map->known_clearance());
    if (truth < 0.05) continue;
    const double error = map->clearance_at(p) - truth;
    // Beside a corner the distance to its cell's centre less half a cell is up to 0.21 cells more
    // than to the corner; on a ridge, interpolation takes up to half a cell off.
    EXPECT_LT(error, 0.21 * 0.05 + 2e-3) << p.transpose();
    EXPECT_GT(error, -0.5 * 0.05) << p.transpose();
  }
}

TEST(ClearanceMap, TheCostOfALineIsTheIntegralOfItsDensity) {
  std::mt19937 random(2);
  const auto map = ClearanceMap::make(test::office(), {});
  ASSERT_TRUE(map.ok());
  std::uniform_real_distribution<double> x(-0.5, 15.5), y(-0.5, 10.5);
  int finite = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector2d a(x(random), y(random)), b(x(random), y(random));
    const double cost = map->segment_cost(a, b);
    double integral = 0.0;
    const int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      integral += map->density_at(a + (b - a) * ((k + 0.5) / steps)) * (b - a).norm() / steps;
    }
    if (std::isfinite(integral)) {
      EXPECT_NEAR(cost, integral, 0.01 * integral);
      ++finite;
    } else if (std::isfinite(cost)) {
      // Only what is nearly allowed may slip through between two looks.
      for (int k = 0; k <= 400; ++k) {
        EXPECT_GT(map->clearance_at(a + (b - a) * (k / 400.0)), 0.35 - 0.02);
      }
    }
    EXPECT_GE(cost, (b - a).norm() * (1 - 1e-12));
  }
  EXPECT_GT(finite, 100);
}

TEST(ClearanceMap, UnknownSpaceCostsMoreOrIsClosed) {
  OccupancyGrid grid = test::hall(6, 6);
  test::paint(grid, 2, 0.1, 4, 5.9, CellState::kUnknown);
  PathCost cost;
  const auto open = ClearanceMap::make(grid, cost);
  ASSERT_TRUE(open.ok());
  EXPECT_DOUBLE_EQ(open->density_at({3, 3}), 1.0 + cost.unknown_weight);
  EXPECT_DOUBLE_EQ(open->density_at({1.5, 3}), 1.0);
  cost.unknown_is_free = false;
  const auto closed = ClearanceMap::make(grid, cost);
  ASSERT_TRUE(closed.ok());
  EXPECT_EQ(closed->density_at({3, 3}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(closed->density_at({1.8, 3}), std::numeric_limits<double>::infinity());
}

TEST(ClearanceMap, ReachesBeyondTheGrid) {
  const OccupancyGrid grid = test::hall(6, 6);
  const auto map = ClearanceMap::make(grid, {}, {{9.0, -4.0}}, 0.5);
  ASSERT_TRUE(map.ok());
  EXPECT_TRUE(map->contains(Eigen::Vector2d(9.4, -4.4)));
  EXPECT_TRUE(map->unknown_at({9.0, -4.0}));
  EXPECT_NEAR(map->clearance_at({3.0, -0.7}), 0.7, 0.01);
  EXPECT_NEAR(map->clearance_at({3.0, -3.0}), map->known_clearance(), 0.01);
  EXPECT_LT(map->clearance_at({90.0, 0.0}), 0.0);
}

TEST(ClearanceMap, AnOpenOneGoesOnOutsideAsOneThatReachesFarther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-20.0, 28.0), near(-1.0, 9.0);
  int across = 0;
  for (int field = 0; field < 20; ++field) {
    OccupancyGrid grid = test::random_field(random, 8.0);
    test::paint(grid, 7.85, 2.0, 8.1, 5.0, CellState::kFree);
    const auto map = ClearanceMap::make(grid, {}, {}, 1.0);
    const auto far = ClearanceMap::make(grid, {}, {{-20.0, -20.0}, {28.0, 28.0}}, 1.0);
    ASSERT_TRUE(map.ok() && far.ok());
    ASSERT_TRUE(map->open());
    const double hard = map->cost().hard_clearance();
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Vector2d a(place(random), place(random)), b(near(random), near(random));
      EXPECT_NEAR(map->clearance_at(a), far->clearance_at(a), 1e-5);
      EXPECT_EQ(map->unknown_at(a), far->unknown_at(a));
      EXPECT_NEAR(std::min(99.0, map->density_at(a)), std::min(99.0, far->density_at(a)), 1e-4);
      const double cost = map->segment_cost(a, b), expected = far->segment_cost(a, b);
      if (std::isfinite(cost) && std::isfinite(expected)) {
        EXPECT_NEAR(cost, expected, 0.01 * expected);
        across += !map->contains(a);
        continue;
      }
      // Looked at at different places, a line that just touches may pass.
      double least = 9.0;
      for (int k = 0; k <= 2000; ++k) {
        least = std::min(least, far->clearance_at(a + (b - a) * (k / 2000.0)));
      }
      EXPECT_LT(least, hard + 0.01);
      if (least < hard - 0.02) {
        EXPECT_FALSE(std::isfinite(cost)) << a.transpose() << " to " << b.transpose();
      }
    }
    // Along an edge and through a corner.
    const Eigen::Vector2d corner = map->origin();
    EXPECT_NEAR(map->segment_cost(corner - Eigen::Vector2d(2, 0), corner - Eigen::Vector2d(0, 2)),
                far->segment_cost(corner - Eigen::Vector2d(2, 0), corner - Eigen::Vector2d(0, 2)),
                0.01);
    EXPECT_NEAR(map->segment_cost(corner - Eigen::Vector2d(0, 2), corner + Eigen::Vector2d(0, 2)),
                6.0, 0.01);
  }
  EXPECT_GT(across, 50);
}

TEST(ClearanceMap, IsClosedWhereTheUnknownIsOrTheBorderIsNarrow) {
  const OccupancyGrid grid = test::hall(6, 6);
  EXPECT_FALSE(ClearanceMap::make(grid, {}, {}, 0.5)->open());
  PathCost cost;
  cost.unknown_is_free = false;
  const auto closed = ClearanceMap::make(grid, cost, {}, 1.0);
  ASSERT_TRUE(closed.ok());
  EXPECT_FALSE(closed->open());
  EXPECT_LT(closed->clearance_at({90.0, 0.0}), 0.0);
  EXPECT_FALSE(std::isfinite(closed->segment_cost({90.0, 0.0}, {91.0, 0.0})));
}

TEST(ClearanceMap, UpdatedItIsTheOneThatAFreshOneWouldBe) {
  std::mt19937 random(3);
  OccupancyGrid grid = test::office();
  ClearanceMap map{PathCost()};
  std::uniform_real_distribution<double> x(-1.0, 16.0), y(-1.0, 11.0);
  for (int update = 0; update < 30; ++update) {
    const Eigen::Vector2d center(x(random), y(random)), reach(x(random), y(random));
    const auto state = static_cast<CellState>(random() % 3);
    test::paint(grid, center.x(), center.y(), center.x() + 0.6, center.y() + 0.3, state);
    if (update == 20) {
      ASSERT_TRUE(grid.cover({-3, -3}, {17, 12}).ok());
    }
    ASSERT_TRUE(map.update(grid, {reach}, 1.0).ok());
    const Eigen::Vector2d far =
        map.origin() + Eigen::Vector2d(map.width() - 0.5, map.height() - 0.5) * map.resolution();
    const auto fresh = ClearanceMap::make(
        grid, {}, {map.origin() + Eigen::Vector2d::Constant(0.5 * map.resolution()), far});
    ASSERT_TRUE(fresh.ok());
    ASSERT_EQ(map.field().values(), fresh->field().values()) << update;
    for (int row = 0; row < map.height(); ++row) {
      for (int column = 0; column < map.width(); ++column) {
        ASSERT_EQ(map.density({column, row}), fresh->density({column, row})) << update;
        ASSERT_EQ(map.unknown_at(map.center_of({column, row})),
                  fresh->unknown_at(map.center_of({column, row})));
      }
    }
  }
  EXPECT_FALSE(map.update(OccupancyGrid()).ok());
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.update(grid).ok());
}

TEST(ClearanceMap, AnotherPlaceIsAnotherMap) {
  ClearanceMap map{PathCost()};
  ASSERT_TRUE(map.update(test::hall(6, 6)).ok());
  OccupancyGrid far(OccupancyGrid::Params(), {5e5, 5e5}, 40, 40);
  ASSERT_TRUE(map.update(far).ok());
  EXPECT_EQ(map.width(), 40);
}

TEST(ClearanceMap, OfAnotherResolutionIsAnotherMap) {
  ClearanceMap map{PathCost()};
  OccupancyGrid::Params coarse;
  coarse.resolution = 0.2;
  ASSERT_TRUE(map.update(OccupancyGrid(coarse, {0, 0}, 30, 30), {}, 1.3).ok());
  EXPECT_TRUE(map.open());
  ASSERT_TRUE(map.update(test::hall(6, 6), {}, 1.0).ok());
  EXPECT_TRUE(map.open()) << "what obstacles are felt at is two cells more than it costs";
  EXPECT_EQ(map.resolution(), 0.05);
}

TEST(ClearanceMap, GrowsByMetresAndNotByCells) {
  OccupancyGrid grid = test::hall(6, 6);
  ClearanceMap map{PathCost()};
  ASSERT_TRUE(map.update(grid, {}, 1.0).ok());
  int sizes = 0, width = map.width();
  EXPECT_EQ(width, 160);
  for (double edge = 6.0; edge < 26.0; edge += 0.1) {
    ASSERT_TRUE(grid.cover({1.0, 1.0}, {edge, 3.0}).ok());
    ASSERT_TRUE(map.update(grid, {}, 1.0).ok());
    EXPECT_TRUE(map.contains(Eigen::Vector2d(edge + 0.9, 0.0)));
    sizes += std::exchange(width, map.width()) != width;
  }
  EXPECT_GE(sizes, 2);
  EXPECT_LE(sizes, 5);
}

TEST(ClearanceMap, RefusesWhatMakesNoMap) {
  const OccupancyGrid grid = test::hall(3, 3);
  EXPECT_FALSE(ClearanceMap::make(OccupancyGrid(), {}).ok());
  EXPECT_FALSE(ClearanceMap::make(grid, {}, {{std::nan(""), 0}}).ok());
  EXPECT_FALSE(ClearanceMap::make(grid, {}, {{1e6, 1e6}}).ok());
  PathCost cost;
  cost.radius = std::nan("");
  EXPECT_FALSE(ClearanceMap::make(grid, cost).ok());
  const ClearanceMap none;
  EXPECT_LT(none.clearance_at({0, 0}), 0.0);
}

}  // namespace
}  // namespace swiftlet
