// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace swiftlet {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Duration kTick = std::chrono::milliseconds(10);

/// A vehicle that does what the guard lets through.
struct GuardedFlight {
  FlightGuard guard;
  Time now{std::chrono::seconds(50)};
  RigidBodyState vehicle;
  FlatReference asked;  // by the commander
  std::vector<Eigen::Vector2d> walls;
  double least = 1e9;

  explicit GuardedFlight(const FlightGuard::Params& params = {}) : guard(params) {}

  /// Whether the guard flies.
  bool tick() {
    now += kTick;
    guard.set_estimate(vehicle);
    guard.set_obstacles(NearObstacles(walls), now);
    const auto instead = guard.check({now, SetpointKind::kTrack, asked});
    const FlatReference flown = instead ? instead->reference : asked;
    EXPECT_TRUE(flown.position.allFinite());
    vehicle.p_WB = flown.position;
    vehicle.v_WB_W = flown.velocity;
    least = std::min(least, NearObstacles(walls).clearance(vehicle.p_WB.head<2>()));
    return instead.has_value();
  }
  void go(const Eigen::Vector3d& velocity) {
    asked.velocity = velocity;
    asked.position += velocity * to_seconds(kTick);
  }
};

TEST(FlightGuard, LetsASoundFlightBe) {
  GuardedFlight flight;
  flight.walls = {{3.0, 0.5}, {3.0, -0.5}, {6.0, 0.0}};
  for (int k = 0; k < 300; ++k) {
    flight.go({1.0, 0.0, 0.1});  // through the gap of a metre, up to 3 m
    EXPECT_FALSE(flight.tick()) << k << ": " << flight.guard.reason();
  }
  EXPECT_EQ(flight.guard.reason(), "");
}

TEST(FlightGuard, StopsAheadOfAWallAtAnySpeedAndFromAnyAngle) {
  for (const double speed : {0.3, 1.0, 2.0, 3.0}) {
    for (int degree = -60; degree <= 60; degree += 20) {
      GuardedFlight flight;
      for (double y = -30.0; y < 30.0; y += 0.05) flight.walls.push_back({6.0, y});
      const double angle = degree * M_PI / 180.0;
      bool acted = false;
      for (int k = 0; k < 6000 && !acted; ++k) {
        flight.go(speed * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
        acted = flight.tick();
      }
      ASSERT_TRUE(acted);
      EXPECT_THAT(flight.guard.reason(), HasSubstr("m to what the LIDAR sees"));
      const double left = 6.0 - flight.vehicle.p_WB.x();
      EXPECT_LT(left, 0.30 + 0.3 * speed + 0.15 * speed * speed) << "not long before it must";
      for (int k = 0; k < 300; ++k) {
        flight.go(speed * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
        EXPECT_TRUE(flight.tick());
      }
      EXPECT_GT(flight.least, 0.25) << speed << " m/s at " << degree;
      EXPECT_EQ(flight.vehicle.v_WB_W.norm(), 0.0);
    }
  }
}

TEST(FlightGuard, NamesWhatCannotBeRight) {
  struct Case {
    FlatReference asked;
    const char* reason;
  };
  FlatReference far, fast, broken;
  far.position.x() = 3.0;
  fast.velocity.y() = 20.0;
  broken.jerk.z() = kNan;
  for (const Case& c :
       {Case{far, "the setpoint is 3.0 m away"}, Case{fast, "the setpoint is for 20.0 m/s"},
        Case{broken, "the setpoint is no number"}}) {
    GuardedFlight flight;
    flight.vehicle.v_WB_W.x() = 0.5;
    flight.asked.velocity.x() = 0.5;
    EXPECT_FALSE(flight.tick());
    flight.asked = c.asked;
    EXPECT_TRUE(flight.tick()) << c.reason << ": in the same moment";
    EXPECT_EQ(flight.guard.reason(), c.reason);
    EXPECT_LT(flight.vehicle.p_WB.norm(), 0.02) << "it goes on from what was flown";
    for (int k = 0; k < 100; ++k) flight.tick();
    EXPECT_EQ(flight.vehicle.v_WB_W.norm(), 0.0);
    EXPECT_LT(flight.vehicle.p_WB.norm(), 0.25);
  }
}

TEST(FlightGuard, GivesItBackToWhoAsksForRestNearBy) {
  GuardedFlight flight;
  flight.asked.position.x() = 5.0;
  EXPECT_TRUE(flight.tick());
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(flight.tick()) << "that is not near by";
  flight.asked = {};
  flight.asked.position = flight.vehicle.p_WB + Eigen::Vector3d(0.1, 0.0, 0.0);
  int held = 0;
  while (held < 100 && flight.tick()) ++held;
  EXPECT_NEAR(held * 0.01, 0.3, 0.02);
  EXPECT_FALSE(flight.guard.acting());
  EXPECT_EQ(flight.guard.reason(), "the setpoint is 5.0 m away") << "for the record";

  flight.asked.velocity.x() = 0.5;
  EXPECT_FALSE(flight.tick()) << "sound setpoints are let through again";
}

TEST(FlightGuard, KeepsWithinTheFenceAndLetsComeBack) {
  FlightGuard::Params params;
  params.fence_radius = 4.0;
  params.fence_height = 3.0;
  GuardedFlight flight(params);
  flight.guard.set_home({1.0, 0.0, 0.0});
  bool acted = false;
  for (int k = 0; k < 1000 && !acted; ++k) {
    flight.go({1.0, 0.0, 0.0});
    acted = flight.tick();
  }
  ASSERT_TRUE(acted);
  EXPECT_GT(flight.vehicle.p_WB.x(), 4.5) << "not long before it must";
  EXPECT_THAT(flight.guard.reason(), HasSubstr("outside of the fence"));
  for (int k = 0; k < 100; ++k) flight.tick();
  EXPECT_GT(flight.vehicle.p_WB.x(), 4.7);
  EXPECT_LE(flight.vehicle.p_WB.x(), 5.0) << "it stops inside";
  flight.asked = {};
  flight.asked.position = flight.vehicle.p_WB;
  for (int k = 0; k < 50; ++k) flight.tick();
  for (int k = 0; k < 100; ++k) {
    flight.go({-1.0, 0.0, 0.0});
    EXPECT_FALSE(flight.tick()) << "back in is no breach";
  }
  acted = false;
  for (int k = 0; k < 1000 && !acted; ++k) {
    flight.go({0.0, 0.0, 1.0});
    acted = flight.tick();
  }
  ASSERT_TRUE(acted);
  EXPECT_THAT(flight.guard.reason(), HasSubstr("above the fence"));
  for (int k = 0; k < 100; ++k) flight.tick();
  EXPECT_GT(flight.vehicle.p_WB.z(), 2.7);
  EXPECT_LE(flight.vehicle.p_WB.z(), 3.0);
}

TEST(FlightGuard, IsNotLuredOutOfTheFenceBySetpointsAtRest) {
  FlightGuard::Params params;
  params.fence_radius = 4.0;
  GuardedFlight flight(params);
  flight.guard.set_home({0.0, 0.0, 0.0});
  // A vehicle that follows a place ahead of it.
  Time now = flight.now;
  Eigen::Vector3d place(0.0, 0.0, 1.2);
  bool acted = false;
  for (int k = 0; k < 2000 && !acted; ++k) {
    now += kTick;
    RigidBodyState vehicle;
    vehicle.p_WB = place;
    vehicle.v_WB_W = {0.5, 0.0, 0.0};
    flight.guard.set_estimate(vehicle);
    FlatReference lure;
    lure.position = place + Eigen::Vector3d(0.9, 0.0, 0.0);
    acted = flight.guard.check({now, SetpointKind::kTrack, lure}).has_value();
    place += vehicle.v_WB_W * to_seconds(kTick);
  }
  ASSERT_TRUE(acted);
  EXPECT_LT(place.x(), 4.0);
  EXPECT_THAT(flight.guard.reason(), HasSubstr("outside of the fence"));
}

TEST(FlightGuard, SaysNothingWhereNothingIsTracked) {
  GuardedFlight flight;
  FlatReference far;
  far.position.x() = 100.0;
  flight.guard.set_estimate({});
  EXPECT_FALSE(flight.guard.check({flight.now, SetpointKind::kMotorsOff, far}).has_value());
  EXPECT_FALSE(flight.guard.check({flight.now, SetpointKind::kLevel, far}).has_value());
  EXPECT_TRUE(flight.guard.check({flight.now, SetpointKind::kTrack, far}).has_value());
  EXPECT_FALSE(flight.guard.check({flight.now, SetpointKind::kLevel, far}).has_value());
  EXPECT_FALSE(flight.guard.acting());
  FlightGuard knows_nothing{FlightGuard::Params{}};
  EXPECT_FALSE(knows_nothing.check({flight.now, SetpointKind::kTrack, far}).has_value());
}

TEST(FlightGuard, WhatWasSeenLongAgoIsNotBelieved) {
  GuardedFlight flight;
  flight.guard.set_obstacles(NearObstacles({{0.3, 0.0}}), flight.now - std::chrono::seconds(1));
  RigidBodyState vehicle;
  vehicle.v_WB_W.x() = 1.0;
  flight.guard.set_estimate(vehicle);
  EXPECT_FALSE(flight.guard.check({flight.now, SetpointKind::kTrack, {}}).has_value());
}

TEST(FlightGuard, UnusableParametersThrow) {
  FlightGuard::Params params;
  params.max_gap = kNan;
  EXPECT_THROW(FlightGuard{params}, std::invalid_argument);
  params = {};
  params.margin = -0.1;
  EXPECT_THROW(FlightGuard{params}, std::invalid_argument);
}

}  // namespace
}  // namespace swiftlet
