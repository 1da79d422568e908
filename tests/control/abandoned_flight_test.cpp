// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/abandoned_flight.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Time at(double seconds) {
  return Time(from_seconds(seconds));
}

FlatReference cruise() {
  FlatReference reference;
  reference.position = Vector3d(2, 1, 1.25);
  reference.velocity = Vector3d(1, 0, 0);
  reference.yaw = 0.4;
  return reference;
}

TEST(AbandonedFlight, BrakesHoldsAndLandsWithoutAStep) {
  AbandonedFlight flight{{}};
  ASSERT_TRUE(flight.begin(at(10.0), at(10.0), cruise()).ok());
  FlatReference last = flight.reference(at(10.0));
  EXPECT_EQ(last.position, cruise().position);
  EXPECT_LT((last.velocity - cruise().velocity).norm(), 1e-12);
  Vector3d place = Vector3d::Zero();
  for (double t = 10.004; t < 20.0; t += 0.004) {
    const FlatReference next = flight.reference(at(t));
    EXPECT_LT((next.position - last.position - 0.004 * last.velocity).norm(), 1e-4);
    EXPECT_LT((next.velocity - last.velocity).norm(), 4.0 * 0.004 * 1.05);
    EXPECT_LT((next.acceleration - last.acceleration).norm(), 30.0 * 0.004 * 1.05);
    EXPECT_EQ(flight.landing(), t >= 13.0 - 1e-9) << t;
    if (t > 11.0 && t < 12.99) place = next.position;
    last = next;
  }
  EXPECT_LT(place.x() - 2.0, 0.3) << "the braking distance";
  EXPECT_EQ(place.z(), 1.25);
  EXPECT_LT((last.velocity - Vector3d(0, 0, -0.4)).norm(), 1e-9);
  EXPECT_LT((last.position.head<2>() - place.head<2>()).norm(), 1e-9) << "straight down";
}

TEST(AbandonedFlight, OneThatWasAbandonedLongAgoLandsFromTheBrake) {
  AbandonedFlight flight{{}};
  ASSERT_TRUE(flight.begin(at(1.0), at(10.0), cruise()).ok());
  EXPECT_LT((flight.reference(at(10.0)).velocity - cruise().velocity).norm(), 1e-9);
  EXPECT_TRUE(flight.landing());
  EXPECT_NEAR(flight.reference(at(11.5)).velocity.z(), -0.4, 1e-9);
}

TEST(AbandonedFlight, LandedIsWhatResistsAsMuchAsItsWitnessesDemand) {
  const auto resistance_needed = [](const GroundSonar& sonar) {
    AbandonedFlight flight{{}};
    EXPECT_TRUE(flight.begin(at(0.0), at(0.0), cruise()).ok());
    flight.reference(at(1.0));
    EXPECT_FALSE(flight.landed(at(1.0), 100.0, sonar)) << "nobody wants to land yet";
    const double below = flight.reference(at(5.0)).position.z();
    double needed = 0.0;
    while (!flight.landed(at(5.0), below + needed, sonar) && needed < 5.0) needed += 0.01;
    return needed;
  };
  GroundSonar sonar{{}};
  EXPECT_NEAR(resistance_needed(sonar), 0.40, 0.011) << "without a sonar";
  sonar.set_range(0.15);
  sonar.step(at(0.0));
  EXPECT_NEAR(resistance_needed(sonar), 0.10, 0.011) << "the sonar sees the ground";
  sonar.set_range(2.0);
  sonar.step(at(0.05));
  EXPECT_NEAR(resistance_needed(sonar), 1.0, 0.011) << "the sonar sees no ground";
  sonar.step(at(0.5));
  EXPECT_NEAR(resistance_needed(sonar), 0.40, 0.011) << "a silent sonar is none";
}

TEST(AbandonedFlight, WhatCannotBeBrakedFromIsRefused) {
  AbandonedFlight flight{{}};
  ASSERT_TRUE(flight.begin(at(0.0), at(0.0), cruise()).ok());
  FlatReference far = cruise();
  far.position.x() = 1e9;
  EXPECT_FALSE(flight.begin(at(1.0), at(1.0), far).ok());
  EXPECT_LT(flight.reference(at(1.0)).position.x(), 3.0) << "what was flown is still there";
}

TEST(AbandonedFlight, UnusableParametersThrow) {
  AbandonedFlight::Params params;
  params.landing_speed = kNan;
  EXPECT_THROW(AbandonedFlight{params}, std::invalid_argument);
  params = {};
  params.resistance_against = 0.2;
  EXPECT_THROW(AbandonedFlight{params}, std::invalid_argument);
  params = {};
  params.braking.jerk = -1.0;
  EXPECT_THROW(AbandonedFlight{params}, std::invalid_argument);
}

TEST(GroundSonar, TellsForHowLongEachReadingWasOneOfTheGround) {
  GroundSonar sonar{{}};
  sonar.step(at(0.0));
  EXPECT_FALSE(sonar.heard());
  for (int k = 1; k <= 20; ++k) {  // each 50 ms
    sonar.set_range(k < 10 ? 1.0 : 0.15);
    sonar.set_range(kNan);
    sonar.step(at(0.05 * k));
    EXPECT_TRUE(sonar.heard());
    EXPECT_EQ(sonar.near_ground_for().has_value(), k >= 10);
  }
  EXPECT_NEAR(*sonar.near_ground_for(), 0.5, 1e-9);
  sonar.set_range(std::numeric_limits<double>::infinity());
  sonar.step(at(1.05));
  EXPECT_TRUE(sonar.heard());
  EXPECT_FALSE(sonar.near_ground_for());
  sonar.set_range(0.15);
  sonar.step(at(1.10));
  EXPECT_EQ(sonar.near_ground_for(), 0.0) << "from the start again";
  sonar.step(at(1.40));
  EXPECT_FALSE(sonar.heard()) << "died";
  EXPECT_FALSE(sonar.near_ground_for());
}

}  // namespace
}  // namespace swiftlet::test
