// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/piecewise_polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace swiftlet {
namespace {

TrajectorySegment random_segment(std::mt19937& random) {
  std::uniform_real_distribution<double> coefficient(-3.0, 3.0), duration(0.2, 5.0);
  TrajectorySegment segment;
  segment.duration_s = duration(random);
  for (Polynomial& c : segment.coefficients) {
    for (int i = 0; i < kCoefficients; ++i) c[i] = coefficient(random);
  }
  return segment;
}

TEST(Trajectory, DerivativesAreThoseOfThePosition) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Trajectory trajectory(Time(from_seconds(12.5)), {random_segment(random)});
    const double T = to_seconds(trajectory.duration());
    const auto at = [&](double t) { return trajectory.evaluate(Time(from_seconds(12.5 + t))); };
    const double h = 1e-5, t = 0.4 * T;
    const FlatReference low = at(t - h), mid = at(t), high = at(t + h);
    const auto expect = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& derivative) {
      EXPECT_LT(((b - a) / (2 * h) - derivative).norm(), 1e-4 * (1.0 + derivative.norm()));
    };
    expect(low.position, high.position, mid.velocity);
    expect(low.velocity, high.velocity, mid.acceleration);
    expect(low.acceleration, high.acceleration, mid.jerk);
    expect(low.jerk, high.jerk, mid.snap);
    EXPECT_NEAR((high.yaw - low.yaw) / (2 * h), mid.yaw_rate, 1e-4 * (1 + std::abs(mid.yaw_rate)));
    EXPECT_NEAR((high.yaw_rate - low.yaw_rate) / (2 * h), mid.yaw_acceleration,
                1e-4 * (1 + std::abs(mid.yaw_acceleration)));
  }
}

TEST(Trajectory, HoldsStillBeforeAndAfter) {
  std::mt19937 random(2);
  const TrajectorySegment a = random_segment(random), b = random_segment(random);
  const Trajectory trajectory(Time(from_seconds(1.0)), {a, b});
  const FlatReference before = trajectory.evaluate(Time(from_seconds(0.0)));
  EXPECT_DOUBLE_EQ(before.position.x(), a.coefficients[kX][0]);
  EXPECT_EQ(before.velocity.norm() + before.acceleration.norm() + before.jerk.norm(), 0.0);
  for (const double late_s : {1e-9, 1.0, 1e6}) {
    const FlatReference after = trajectory.evaluate(trajectory.end() + from_seconds(late_s));
    EXPECT_NEAR(after.position.y(), b.coefficients[kY].sum(), 1e-12);
    EXPECT_NEAR(after.yaw, b.coefficients[kYaw].sum(), 1e-12);
    EXPECT_EQ(after.velocity.norm() + after.snap.norm() + std::abs(after.yaw_rate), 0.0);
  }
  EXPECT_EQ(trajectory.duration(), from_seconds(a.duration_s + b.duration_s));
}

TEST(Trajectory, ExtremaAreBoundsThatAreTaken) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const TrajectorySegment segment = random_segment(random);
    for (const int order : {1, 2, 3, 4}) {
      const double bound = max_derivative_norm(segment, order);
      double seen = 0.0;
      for (int i = 0; i <= 4000; ++i) {
        const double s = i / 4000.0;
        const Eigen::Vector3d d(derivative(segment, kX, s, order),
                                derivative(segment, kY, s, order),
                                derivative(segment, kZ, s, order));
        seen = std::max(seen, d.norm());
      }
      ASSERT_GE(bound, seen * (1 - 1e-9)) << trial << " order " << order;
      ASSERT_LE(bound, seen * (1 + 1e-4)) << trial << " order " << order;
    }
  }
}

TEST(Trajectory, ExtremaOfAKnownCurve) {
  // x = s^2 (3 - 2 s) over 2 s: greatest speed 1.5 / 2 in the middle, acceleration 6 / 4 at the
  // ends.
  TrajectorySegment segment;
  segment.duration_s = 2.0;
  segment.coefficients[kX][2] = 3.0;
  segment.coefficients[kX][3] = -2.0;
  const Trajectory trajectory(Time{}, {segment});
  EXPECT_NEAR(trajectory.max_speed(), 0.75, 1e-6);
  EXPECT_NEAR(trajectory.max_acceleration(), 1.5, 1e-6);
}

TEST(Trajectory, WhatIsNotSoundIsEmpty) {
  std::mt19937 random(4);
  TrajectorySegment bad = random_segment(random);
  bad.coefficients[kZ][5] = std::nan("");
  EXPECT_TRUE(Trajectory(Time{}, {random_segment(random), bad}).empty());
  for (const double duration : {0.0, -1.0, std::nan(""), 1e300}) {
    TrajectorySegment segment = random_segment(random);
    segment.duration_s = duration;
    EXPECT_TRUE(Trajectory(Time{}, {segment}).empty()) << duration;
  }
  const Trajectory empty;
  EXPECT_EQ(empty.evaluate(Time(from_seconds(3.0))).position.norm(), 0.0);
  EXPECT_EQ(empty.max_speed(), 0.0);
  EXPECT_EQ(empty.duration(), Duration::zero());
}

}  // namespace
}  // namespace swiftlet
