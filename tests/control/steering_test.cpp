// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/steering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr Duration kPiece = std::chrono::milliseconds(25);

/// A reference that is steered tick by tick, and the worst that it did.
struct Steered {
  SteeringLimits limits;
  ReferenceLimits braking{1.0, 2.0, 15.0, 2.0, 10.0};
  Time now{std::chrono::seconds(5)};
  Trajectory flown = resting_at({}, now);
  double acceleration = 0.0, jerk = 0.0, jerk_step = 0.0, velocity_step = 0.0;

  FlatReference at() const { return flown.evaluate(now); }

  void steer_for(double seconds, const Steering& wanted) {
    for (const Time end = now + from_seconds(seconds); now < end;) {
      flown = steer(now, kPiece, at(), wanted, limits, braking);
      ASSERT_FALSE(flown.empty());
      const FlatReference before = at();
      now += kTick;
      const FlatReference after = at();
      acceleration = std::max(acceleration, after.acceleration.norm());
      jerk = std::max(jerk, after.jerk.norm());
      jerk_step = std::max(jerk_step, (after.jerk - before.jerk).norm());
      velocity_step = std::max(velocity_step, (after.velocity - before.velocity).norm());
    }
  }
};

TEST(Steering, FullSticksInAnyDirectionAskForFullSpeed) {
  const SteeringLimits limits;
  for (int degree = 0; degree < 360; degree += 15) {
    const double angle = degree * M_PI / 180.0;
    Sticks sticks;
    sticks.forward = std::cos(angle);
    sticks.left = std::sin(angle);
    const Steering asked = steering(sticks, 0.5, limits);
    EXPECT_NEAR(asked.velocity.norm(), limits.speed, 1e-12) << degree;
    EXPECT_NEAR(std::remainder(std::atan2(asked.velocity.y(), asked.velocity.x()) - angle - 0.5,
                               2.0 * M_PI),
                0.0, 1e-12);
  }
  const Steering corner = steering({1.0, 1.0, 1.0, -1.0, false}, 0.0, limits);
  EXPECT_NEAR(corner.velocity.head<2>().norm(), limits.speed, 1e-12) << "no faster than straight";
  EXPECT_NEAR(corner.velocity.z(), limits.climb_speed, 1e-12);
  EXPECT_NEAR(corner.yaw_rate, -limits.turn_rate, 1e-12);
}

TEST(Steering, TheDeadBandAsksForNothingAndBeginsAtNothing) {
  const SteeringLimits limits;
  const double edge = limits.dead_band;
  const Steering within = steering({edge, 0.0, edge, -edge, false}, 1.0, limits);
  EXPECT_EQ(within.velocity, Eigen::Vector3d::Zero());
  EXPECT_EQ(within.yaw_rate, 0.0);
  EXPECT_NEAR(steering({edge + 1e-6, 0, 0, 0, false}, 0.0, limits).velocity.x(), 0.0, 1e-5);
  EXPECT_TRUE(std::isnan(Sticks({kNan, 0, 0, 0, false}).deflection()));
  EXPECT_EQ(Sticks({0.1, -0.7, 0, 0.3, false}).deflection(), 0.7);
}

TEST(Steering, AVelocityComesWithoutOvershootAndWithinTheLimits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anything(-1.0, 1.0);
  for (int round = 0; round < 30; ++round) {
    Steered flight;
    const Eigen::Vector3d velocity(anything(random), anything(random), 0.5 * anything(random));
    flight.steer_for(4.0, {velocity, anything(random)});
    EXPECT_LT((flight.at().velocity - velocity).norm(), 0.005);
    EXPECT_LE(flight.acceleration, 1.1 * flight.limits.acceleration);
    EXPECT_LE(flight.jerk, 1.1 * flight.limits.jerk);
    EXPECT_LE(flight.jerk_step, 1.01 * flight.limits.snap * to_seconds(kTick));
    // And another one from there: sticks move at any time.
    flight.steer_for(0.15, {-velocity, 0.0});
    flight.steer_for(4.0, {Eigen::Vector3d(0.3, 0.2, 0.0), 0.0});
    EXPECT_LT((flight.at().velocity - Eigen::Vector3d(0.3, 0.2, 0.0)).norm(), 0.005);
    EXPECT_LE(flight.acceleration, 1.1 * flight.limits.acceleration);
    EXPECT_LE(flight.jerk, 1.1 * flight.limits.jerk);
  }
}

TEST(Steering, FromRestToFullSpeedItNeverGoesFaster) {
  Steered flight;
  double fastest = 0.0;
  for (int k = 0; k < 400; ++k) {
    flight.steer_for(0.01, {Eigen::Vector3d::UnitX(), 0.0});
    fastest = std::max(fastest, flight.at().velocity.x());
  }
  EXPECT_LE(fastest, 1.01);
  EXPECT_GE(fastest, 0.999);
}

TEST(Steering, WhoFallsSilentLeavesAVehicleThatStops) {
  Steered flight;
  flight.steer_for(3.0, {Eigen::Vector3d(0.8, 0.6, 0.0), 0.5});
  const Eigen::Vector3d place = flight.at().position;
  const FlatReference rest = flight.flown.final_reference();
  EXPECT_EQ(rest.velocity, Eigen::Vector3d::Zero());
  EXPECT_EQ(rest.yaw_rate, 0.0);
  EXPECT_LT((rest.position - place).norm(), 0.65) << "from 1 m/s with 2 m/s^2";
  EXPECT_LE(flight.flown.max_acceleration(), 2.1);
}

TEST(Steering, AReferenceThatCannotBeGivesNone) {
  FlatReference broken;
  broken.velocity.x() = kNan;
  EXPECT_TRUE(steer(Time{}, kPiece, broken, {}, {}, {}).empty());
  EXPECT_TRUE(steer(Time{}, kPiece, {}, {Eigen::Vector3d(kNan, 0, 0), 0}, {}, {}).empty());
}

TEST(Easing, BringsErrorAndRateToZeroTogether) {
  constexpr double kGain = 1.2, kSlope = 0.6;
  EXPECT_EQ(easing(0.0, kGain, kSlope), 0.0);
  EXPECT_EQ(easing(-2.0, kGain, kSlope), -easing(2.0, kGain, kSlope));
  double before = 0.0;
  for (double error = 0.001; error < 5.0; error += 0.001) {
    const double rate = easing(error, kGain, kSlope);
    EXPECT_GE(rate, before);
    // Its own change, going down the error at that rate: d(rate)/dt = rate d(rate)/d(error).
    EXPECT_LE(rate * (rate - before) / 0.001, kSlope * 1.01);
    before = rate;
  }
}

}  // namespace
}  // namespace swiftlet
