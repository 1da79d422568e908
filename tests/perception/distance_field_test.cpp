// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/distance_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace swiftlet {
namespace {

OccupancyGrid random_grid(std::mt19937& random, int width, int height, double share) {
  OccupancyGrid::Params params;
  params.resolution = 0.1;
  OccupancyGrid grid(params, {-3.0, 2.0}, width, height);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double draw = uniform(random);
      grid.set_state({x, y}, draw < share ? CellState::kOccupied
                             : draw < 0.9 ? CellState::kFree
                                          : CellState::kUnknown);
    }
  }
  return grid;
}

/// Every pair of cells.
double brute_force(const OccupancyGrid& grid, Cell cell, bool unknown_is_obstacle, double max) {
  double nearest = max;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const CellState state = grid.state({x, y});
      if (state == CellState::kFree) continue;
      if (state == CellState::kUnknown && !unknown_is_obstacle) continue;
      nearest = std::min(nearest, grid.resolution() * std::hypot(x - cell.x, y - cell.y));
    }
  }
  return nearest;
}

TEST(DistanceField, IsExactEverywhere) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const int width = 1 + static_cast<int>(random() % 40),
              height = 1 + static_cast<int>(random() % 40);
    const double share = trial % 3 == 0 ? 0.002 : trial % 3 == 1 ? 0.05 : 0.4;
    const OccupancyGrid grid = random_grid(random, width, height, share);
    for (const bool unknown_is_obstacle : {false, true}) {
      DistanceField::Params params;
      params.unknown_is_obstacle = unknown_is_obstacle;
      params.max_distance = 50.0;
      const DistanceField field(grid, params);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          ASSERT_NEAR(field.distance({x, y}), brute_force(grid, {x, y}, unknown_is_obstacle, 50.0),
                      1e-5)
              << trial << " at " << x << " " << y;
        }
      }
    }
  }
}

TEST(DistanceField, UpdateForgetsTheOldGrid) {
  std::mt19937 random(2);
  DistanceField field;
  field.update(random_grid(random, 30, 20, 0.3));
  const OccupancyGrid now = random_grid(random, 17, 23, 0.02);
  field.update(now);
  EXPECT_EQ(field.values(), DistanceField(now, {}).values());
  EXPECT_EQ(field.width(), 17);
  EXPECT_EQ(field.origin(), now.origin());
}

TEST(DistanceField, UpdatesAreToTheBitWhatANewFieldIs) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 40; ++trial) {
    const int width = 1 + static_cast<int>(random() % 60),
              height = 1 + static_cast<int>(random() % 60);
    DistanceField::Params params;
    params.max_distance = trial % 4 == 0 ? 1e3 : 0.05 * static_cast<double>(random() % 30);
    params.unknown_is_obstacle = trial % 5 == 0;
    OccupancyGrid grid = random_grid(random, width, height, trial % 2 == 0 ? 0.01 : 0.3);
    DistanceField field(grid, params);
    for (int update = 0; update < 20; ++update) {
      const std::vector<float> before = field.values();
      for (unsigned change = 0; change < random() % 12; ++change) {
        const Cell cell{static_cast<int>(random()) % width, static_cast<int>(random()) % height};
        grid.set_state(cell, static_cast<CellState>(random() % 3));
      }
      field.update(grid);
      ASSERT_EQ(field.values(), DistanceField(grid, params).values()) << trial << " " << update;
      // What it says to have left alone is as it was.
      std::vector<float> after = field.values();
      for (const RowSpan& span : field.changed()) {
        for (int x = span.first; x <= span.last; ++x) {
          const auto i = static_cast<std::size_t>(span.y * width + x);
          ASSERT_GE(after[i], 0.0F) << "no cell twice";
          after[i] = -1.0F;
        }
      }
      for (std::size_t i = 0; i < after.size(); ++i) {
        ASSERT_TRUE(after[i] < 0.0F || after[i] == before[i]);
      }
    }
  }
}

TEST(DistanceField, AnUpdateLooksNoFartherThanItMust) {
  OccupancyGrid::Params grid_params;
  OccupancyGrid grid(grid_params, {0, 0}, 200, 200);
  DistanceField::Params params;
  params.max_distance = 0.5;  // ten cells
  DistanceField field(grid, params);
  field.update(grid);
  EXPECT_TRUE(field.changed().empty());
  grid.set_state({100, 50}, CellState::kOccupied);
  field.update(grid);
  int cells = 0;
  for (const RowSpan& span : field.changed()) cells += span.last - span.first + 1;
  EXPECT_GE(cells, 21 * 21 - 4 * 10 * 10);
  EXPECT_LE(cells, 23 * 23);
}

TEST(DistanceField, BetweenCentresItIsInterpolatedAndNeverSteeperThanItShould) {
  std::mt19937 random(3);
  const OccupancyGrid grid = random_grid(random, 40, 30, 0.02);
  const DistanceField field(grid, {});
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_NEAR(field.distance_at(grid.center_of({x, y})), field.distance({x, y}), 1e-6);
    }
  }
  std::uniform_real_distribution<double> ux(-3.5, 1.5), uy(1.5, 5.5), step(-0.05, 0.05);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d a(ux(random), uy(random));
    const Eigen::Vector2d b = a + Eigen::Vector2d(step(random), step(random));
    // A distance changes at most as fast as one moves; bilinear, along the diagonal, sqrt(2) of it.
    ASSERT_LE(std::abs(field.distance_at(a) - field.distance_at(b)),
              1.4143 * (a - b).norm() + 1e-9);
  }
}

TEST(DistanceField, WithoutObstaclesOrCellsItIsFarButFinite) {
  OccupancyGrid::Params grid_params;
  const OccupancyGrid open(grid_params, {0, 0}, 5, 4);
  DistanceField::Params params;
  params.max_distance = 7.0;
  EXPECT_EQ(DistanceField(open, params).distance({2, 2}), 7.0);
  const DistanceField empty{OccupancyGrid(), params};
  EXPECT_TRUE(empty.empty());
  EXPECT_EQ(empty.distance_at({1.0, 1.0}), 7.0);
  EXPECT_EQ(DistanceField(open, params).distance_at({std::nan(""), 0.0}), 0.0);
  EXPECT_EQ(DistanceField(open, params).distance_at({1e300, -1e300}), 7.0);
}

}  // namespace
}  // namespace swiftlet
