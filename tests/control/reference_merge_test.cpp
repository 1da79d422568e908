// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/reference_merge.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "control/flight_loop.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

const ReferenceLimits kBraking{1.0, 4.0, 30.0, 2.0, 10.0};
const ReferenceLimits kUndoing{0.5, 1.5, 10.0, 2.0, 10.0};

FlatReference some_reference(std::mt19937& random) {
  std::normal_distribution<double> normal;
  FlatReference reference;
  for (int i = 0; i < 3; ++i) {
    reference.position(i) = normal(random);
    reference.velocity(i) = 0.7 * normal(random);
    reference.acceleration(i) = normal(random);
  }
  reference.yaw = 2.0 * normal(random);
  reference.yaw_rate = 0.3 * normal(random);
  return reference;
}

TEST(ReferenceMerge, LeadsFromOneMotionOntoTheOtherWithoutAStep) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    const FlatReference flown = some_reference(random);
    FlatReference target = some_reference(random);
    target.acceleration.setZero();
    target.yaw_rate = 0.0;
    const Time start(std::chrono::seconds(3));
    const auto wanted = [&](double t) { return extrapolate(target, t); };
    ReferenceMerge merge;
    merge.begin(start, flown, wanted(0.0), kBraking, kUndoing);
    const auto at = [&](double t) { return merge.apply(start + from_seconds(t), wanted(t)); };

    EXPECT_LT((at(0.0).position - flown.position).norm(), 1e-9);
    EXPECT_LT((at(0.0).velocity - flown.velocity).norm(), 1e-9);
    EXPECT_LT((at(0.0).acceleration - flown.acceleration).norm(), 1e-9);
    EXPECT_NEAR(wrap_angle(at(0.0).yaw - flown.yaw), 0.0, 1e-9);
    EXPECT_NEAR(at(0.0).yaw_rate, flown.yaw_rate, 1e-9);
    constexpr double kStep = 1e-4;
    double end = 0.0;
    while (!merge.finished(start + from_seconds(end))) end += 0.01;
    ASSERT_LT(end, 30.0);
    for (double t = kStep; t < end + 0.1; t += 0.0173) {
      const FlatReference a = at(t - kStep), b = at(t), c = at(t + kStep);
      EXPECT_LT(((c.position - a.position) / (2 * kStep) - b.velocity).norm(), 1e-4);
      EXPECT_LT(((c.velocity - a.velocity) / (2 * kStep) - b.acceleration).norm(), 1e-2);
      EXPECT_LT(std::abs((c.yaw - a.yaw) / (2 * kStep) - b.yaw_rate), 1e-4);
      // Each part keeps to its limits; together they are no more than their sum.
      EXPECT_LE(b.acceleration.norm(), std::max(4.0, 2.0 * flown.acceleration.norm()) + 1.6);
    }
    EXPECT_EQ(at(end).position, wanted(end).position);
    EXPECT_EQ(at(end).velocity, wanted(end).velocity);
  }
}

TEST(ReferenceMerge, TakesTheShortWayRoundTheHeading) {
  FlatReference flown, target;
  flown.yaw = 3.1;
  target.yaw = -3.1;
  ReferenceMerge merge;
  merge.begin({}, flown, target, kBraking, kUndoing);
  EXPECT_NEAR(wrap_angle(merge.apply({}, target).yaw - 3.1), 0.0, 1e-9);
  for (double t = 0.0; t < 3.0; t += 0.01) {
    const double yaw = merge.apply(Time(from_seconds(t)), target).yaw;
    EXPECT_LT(std::abs(wrap_angle(yaw - M_PI)), 0.05);
  }
}

TEST(ReferenceMerge, WhatCannotBeMergedIsFlownAsItIs) {
  for (const double far : {1e7, std::numeric_limits<double>::quiet_NaN()}) {
    FlatReference flown, target;
    flown.position.x() = far;
    ReferenceMerge merge;
    merge.begin({}, flown, target, kBraking, kUndoing);
    EXPECT_TRUE(merge.finished({}));
    EXPECT_EQ(merge.apply({}, target).position, target.position);
  }
}

}  // namespace
}  // namespace swiftlet::test
