// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "control/flatness.hpp"
#include "planner/trajectory/body_rate.hpp"
#include "tests/planner/trajectory/random_waypoints.hpp"
#include "tests/planner/trajectory/sampled_extrema.hpp"

namespace swiftlet {
namespace {

using test::moving;
using test::random_waypoints;
using test::sampled_extrema;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Trajectory random_trajectory(std::mt19937& random, double seconds_a_piece) {
  const auto start = moving(random, 1.0, 1.0);
  const std::vector<double> durations(4, seconds_a_piece);
  return *minimum_snap(Time{}, start, random_waypoints(random, 4, 3.0), durations);
}

TEST(BodyRate, IsThatOfTheAttitudeThatFlatnessGives) {
  std::mt19937 random(1);
  std::normal_distribution<double> n;
  for (int trial = 0; trial < 1000; ++trial) {
    FlatReference reference;
    reference.acceleration = {4 * n(random), 4 * n(random), 3 * n(random)};
    reference.jerk = {9 * n(random), 9 * n(random), 9 * n(random)};
    reference.yaw = 3 * n(random);
    reference.yaw_rate = 2 * n(random);
    const double expected = flat_state(reference).w_WB_B.norm();
    ASSERT_NEAR(body_rate(reference), expected, 1e-9 * (1.0 + expected)) << trial;
  }
}

TEST(BodyRate, OfAHoverThatTurnsIsTheYawRate) {
  FlatReference reference;
  reference.yaw_rate = -0.7;
  EXPECT_NEAR(body_rate(reference), 0.7, 1e-12);
}

TEST(BodyRate, HasNoBoundInFreeFall) {
  FlatReference falling;
  falling.acceleration.z() = -kGravity;
  EXPECT_EQ(body_rate(falling), kInfinity);
  TrajectorySegment segment;  // z = -g s^2 + s^5 turns the thrust over
  segment.duration_s = 1.0;
  segment.coefficients[kX][3] = 1.0;
  segment.coefficients[kZ][2] = -kGravity;
  segment.coefficients[kZ][5] = 1.0;
  EXPECT_EQ(max_body_rate(segment), kInfinity);
}

TEST(Extrema, AreBoundsThatAreTaken) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 120; ++trial) {
    // From gentle flight to what a multirotor can hardly do.
    const Trajectory trajectory = random_trajectory(random, 1.2 + 0.05 * (trial % 60));
    for (const TrajectorySegment& segment : trajectory.segments()) {
      const TrajectoryExtrema bound = extrema(segment);
      const TrajectoryExtrema seen = sampled_extrema(segment, 4000);
      const auto expect_above = [&](double value, double sample, const char* what) {
        ASSERT_GE(value, sample * (1 - 1e-9)) << trial << " " << what;
        ASSERT_LE(value, sample * (1 + 2e-4) + 1e-9) << trial << " " << what;
      };
      expect_above(bound.max_speed, seen.max_speed, "speed");
      expect_above(bound.max_acceleration, seen.max_acceleration, "acceleration");
      expect_above(bound.max_thrust_per_mass, seen.max_thrust_per_mass, "thrust");
      expect_above(bound.max_yaw_rate, seen.max_yaw_rate, "yaw rate");
      if (seen.min_thrust_per_mass > 0.5) {
        expect_above(bound.max_body_rate, seen.max_body_rate, "body rate");
      }
      ASSERT_LE(bound.min_thrust_per_mass, seen.min_thrust_per_mass * (1 + 1e-9)) << trial;
      ASSERT_GE(bound.min_thrust_per_mass, seen.min_thrust_per_mass - 2e-3) << trial;
    }
  }
}

TEST(Extrema, OfAClimbAreKnown) {
  // z = 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7 in 2 s: acceleration +-a at (5 -+ sqrt(5)) / 10.
  TrajectorySegment segment;
  segment.duration_s = 2.0;
  segment.coefficients[kZ].segment<4>(4) << 35, -84, 70, -20;
  const double a = 84.0 / (5 * std::sqrt(5.0)) / 4;
  const TrajectoryExtrema found = extrema(segment);
  EXPECT_NEAR(found.max_speed, 35.0 / 16 / 2, 1e-5);
  EXPECT_NEAR(found.max_acceleration, a, 1e-5);
  EXPECT_NEAR(found.max_thrust_per_mass, kGravity + a, 1e-4);
  EXPECT_NEAR(found.min_thrust_per_mass, kGravity - a, 1e-4);
  EXPECT_EQ(found.max_body_rate, 0.0);  // straight up
  EXPECT_EQ(found.max_yaw_rate, 0.0);
}

TEST(Limits, AreKeptExactlyWhereNoStretchIsNeeded) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> factor(0.7, 1.4);
  int kept = 0, broken = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Trajectory trajectory = random_trajectory(random, 2.5);
    for (const TrajectorySegment& segment : trajectory.segments()) {
      const TrajectoryExtrema most = extrema(segment);
      TrajectoryLimits limits;
      limits.max_speed = factor(random) * most.max_speed;
      limits.max_acceleration = factor(random) * most.max_acceleration;
      // A piece may well stay above or below the thrust of a hover.
      limits.max_thrust_per_mass =
          kGravity + factor(random) * std::max(0.1, most.max_thrust_per_mass - kGravity);
      limits.min_thrust_per_mass =
          kGravity - factor(random) * std::max(0.1, kGravity - most.min_thrust_per_mass);
      limits.max_body_rate = factor(random) * most.max_body_rate;
      limits.max_yaw_rate = factor(random) * most.max_yaw_rate;
      const bool within_all =
          most.max_speed <= limits.max_speed && most.max_acceleration <= limits.max_acceleration &&
          most.max_thrust_per_mass <= limits.max_thrust_per_mass &&
          most.min_thrust_per_mass >= limits.min_thrust_per_mass &&
          most.max_body_rate <= limits.max_body_rate && most.max_yaw_rate <= limits.max_yaw_rate;
      EXPECT_EQ(needed_stretch(segment, limits) <= 1.0, within_all);
      EXPECT_EQ(within(most, limits).ok(), within_all);
      EXPECT_EQ(usage(most, limits) <= 1.0, within_all);
      ++(within_all ? kept : broken);
    }
  }
  EXPECT_GT(kept, 3);
  EXPECT_GT(broken, 100);
}

TEST(Limits, SayWhichOfThemIsBroken) {
  TrajectoryExtrema most;
  most.max_speed = 1.25;
  most.min_thrust_per_mass = 3.0;
  TrajectoryLimits limits;
  EXPECT_EQ(within(most, limits).error().reason,
            "the speed reaches 1.25 m/s, above the limit of 1 m/s");
  limits.min_thrust_per_mass = 4.0;
  limits.max_speed = 2.0;
  EXPECT_EQ(within(most, limits).error().reason,
            "the thrust per mass falls to 3 m/s^2, below the limit of 4 m/s^2");
  limits.max_body_rate = 2.0;
  most.max_body_rate = std::nan("");
  EXPECT_THAT(within(most, limits).error().reason, testing::HasSubstr("body rate"));
}

TEST(Limits, MustLeaveRoomForAHover) {
  TrajectoryLimits limits;
  EXPECT_TRUE(check(limits).ok());
  limits.max_thrust_per_mass = 9.0;
  EXPECT_THAT(check(limits).error().reason, testing::HasSubstr("9.807"));
  limits = {};
  limits.min_thrust_per_mass = 9.9;
  EXPECT_FALSE(check(limits).ok());
  for (double TrajectoryLimits::*limit :
       {&TrajectoryLimits::max_speed, &TrajectoryLimits::max_acceleration,
        &TrajectoryLimits::max_body_rate, &TrajectoryLimits::max_yaw_rate}) {
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      limits = {};
      limits.*limit = bad;
      EXPECT_FALSE(check(limits).ok());
    }
  }
}

TEST(Limits, AShareOfThemIsAShareOfTheRoomAboveAHover) {
  TrajectoryLimits limits;
  limits.max_speed = 2.0;
  limits.max_thrust_per_mass = kGravity + 4.0;
  limits.min_thrust_per_mass = kGravity - 6.0;
  const TrajectoryLimits half = share_of(limits, 0.5);
  EXPECT_DOUBLE_EQ(half.max_speed, 1.0);
  EXPECT_DOUBLE_EQ(half.max_thrust_per_mass, kGravity + 2.0);
  EXPECT_DOUBLE_EQ(half.min_thrust_per_mass, kGravity - 3.0);
  EXPECT_EQ(half.max_body_rate, kInfinity);
  EXPECT_EQ(share_of(TrajectoryLimits(), 0.5).min_thrust_per_mass, 0.0);
}

}  // namespace
}  // namespace swiftlet
