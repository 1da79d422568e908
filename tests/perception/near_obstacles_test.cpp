// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/near_obstacles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(NearObstacles, WithoutAnyEverythingIsFree) {
  const NearObstacles none;
  EXPECT_EQ(none.clearance({1.0, 2.0}), kInfinity);
  EXPECT_FALSE(none.nearest({1.0, 2.0}).has_value());
  EXPECT_EQ(none.free_way({1.0, 2.0}, Vector2d::UnitX(), 0.5), kInfinity);
}

TEST(NearObstacles, WhatIsNoNumberIsLeftOut) {
  const NearObstacles obstacles({{std::nan(""), 0.0}, {3.0, 0.0}, {0.0, kInfinity}});
  EXPECT_EQ(obstacles.clearance(Vector2d::Zero()), 3.0);
  EXPECT_EQ(obstacles.nearest(Vector2d::Zero()), Vector2d(3.0, 0.0));
}

TEST(NearObstacles, ADiscThatTouchesHasNoWayTowardsButOneAway) {
  const NearObstacles obstacles({{1.0, 0.0}});
  const Vector2d near(0.6, 0.0);  // within a disc of 0.5
  EXPECT_EQ(obstacles.free_way(near, Vector2d::UnitX(), 0.5), 0.0);
  EXPECT_EQ(obstacles.free_way(near, -Vector2d::UnitX(), 0.5), kInfinity);
  EXPECT_EQ(obstacles.free_way(near, Vector2d::UnitY(), 0.5), kInfinity) << "past it";
}

/// Against a walk in small steps.
TEST(NearObstacles, TheFreeWayEndsWhereTheDiscTouchesFirst) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-3.0, 3.0), turn(0.0, 2.0 * M_PI), size(0.1, 0.8);
  int ended = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Vector2d> points;
    for (int i = 0; i < 6; ++i) points.push_back({place(random), place(random)});
    const NearObstacles obstacles(points);
    const double radius = size(random), angle = turn(random);
    const Vector2d begin(0.3 * place(random), 0.3 * place(random));
    const Vector2d direction(std::cos(angle), std::sin(angle));
    if (obstacles.clearance(begin) <= radius) continue;
    const double way = obstacles.free_way(begin, direction, radius);
    constexpr double kStep = 1e-3;
    double walked = 0.0;
    while (walked < 6.0 && obstacles.clearance(begin + walked * direction) > radius)
      walked += kStep;
    if (walked >= 6.0) {
      EXPECT_GT(way, 5.9);
    } else {
      EXPECT_NEAR(way, walked, 2.0 * kStep);
      ++ended;
    }
  }
  EXPECT_GT(ended, 30);
}

}  // namespace
}  // namespace swiftlet
