// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/steady_descent.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

FlatReference some_reference(std::mt19937& random) {
  std::normal_distribution<double> normal;
  FlatReference from;
  for (int i = 0; i < 3; ++i) {
    from.position(i) = 3.0 * normal(random);
    from.velocity(i) = normal(random);
    from.acceleration(i) = normal(random);
  }
  from.yaw = normal(random);
  from.yaw_rate = 0.3 * normal(random);
  return from;
}

TEST(SteadyDescent, BeginsOnTheReferenceAndSinksStraight) {
  std::mt19937 random(5);
  const ReferenceLimits limits{1.0, 4.0, 30.0, 2.0, 10.0};
  for (int round = 0; round < 50; ++round) {
    const FlatReference from = some_reference(random);
    const Time start{std::chrono::seconds(round)};
    const auto descent = SteadyDescent::begin(start, from, 0.4, limits);
    ASSERT_TRUE(descent.ok());
    const FlatReference first = descent->at(start);
    EXPECT_LT((first.position - from.position).norm(), 1e-12);
    EXPECT_LT((first.velocity - from.velocity).norm(), 1e-12);
    EXPECT_LT((first.acceleration - from.acceleration).norm(), 1e-12);
    EXPECT_NEAR(first.yaw, from.yaw, 1e-12);
    // Velocity is the derivative of position all the way, and acceleration that of velocity.
    constexpr double kStep = 1e-4;
    for (double t = 0.01; t < 8.0; t += 0.037) {
      const Time time = start + from_seconds(t);
      const FlatReference a = descent->at(time - from_seconds(kStep));
      const FlatReference b = descent->at(time), c = descent->at(time + from_seconds(kStep));
      EXPECT_LT(((c.position - a.position) / (2 * kStep) - b.velocity).norm(), 1e-4);
      EXPECT_LT(((c.velocity - a.velocity) / (2 * kStep) - b.acceleration).norm(), 1e-2);
      EXPECT_LE(b.acceleration.norm(), std::max(4.0, from.acceleration.norm()) * 1.05);
    }
    const FlatReference later = descent->at(start + from_seconds(9.0));
    EXPECT_LT((later.velocity - Vector3d(0, 0, -0.4)).norm(), 1e-12);
    EXPECT_EQ(later.acceleration.norm(), 0.0);
    EXPECT_EQ(later.yaw_rate, 0.0);
  }
}

TEST(SteadyDescent, WhatCannotBeFlownIsRefused) {
  FlatReference broken;
  broken.velocity.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SteadyDescent::begin({}, broken, 0.4, {}).ok());
  EXPECT_FALSE(SteadyDescent::begin({}, {}, std::numeric_limits<double>::infinity(), {}).ok());
}

}  // namespace
}  // namespace swiftlet::test
