// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Straight lines: GPS Guidance.
#include <algorithm>
#include <cmath>

#include "director_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::HasSubstr;

/// From a place to a straight line [m].
double off_line(const Eigen::Vector3d& p, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d direction = (to - from).normalized();
  return (p - from - direction * (p - from).dot(direction)).norm();
}

TEST(FlightDirectorGps, ClimbsAtFirstAndThenFliesStraight) {
  DirectorFlight flight;
  flight.take_off();
  const Eigen::Vector3d first(20.0, 10.0, 15.0), second(5.0, 18.0, 15.0);
  ASSERT_TRUE(flight.director.fly_straight(7, {{first, {}}, {second, {}}}, flight.now).ok());
  EXPECT_EQ(flight.mode(), Mode::kGpsGuidance);
  ASSERT_TRUE(flight.tick_until([&] { return flight.vehicle.p_WB.z() > 14.999; }, 40.0));
  EXPECT_LT(flight.vehicle.p_WB.head<2>().norm(), 1e-6) << "straight up";
  const Eigen::Vector3d top = flight.vehicle.p_WB;
  double worst = 0.0, fastest = 0.0;
  ASSERT_TRUE(flight.tick_until(
      [&] {
        worst = std::max(worst, off_line(flight.vehicle.p_WB, top, first));
        fastest = std::max(fastest, flight.vehicle.v_WB_W.norm());
        return flight.status().waypoint == 2;
      },
      40.0));
  EXPECT_LT((flight.vehicle.p_WB - first).norm(), 0.15);
  EXPECT_LT(worst, 0.01);
  EXPECT_NEAR(fastest, 3.0, 0.01);
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 40.0));
  EXPECT_LT((flight.vehicle.p_WB - second).norm(), 0.15);
  EXPECT_TRUE(flight.status().mission_done);
  EXPECT_EQ(flight.transitions.back(), "GPS Guidance -> Hover: mission finished");
}

TEST(FlightDirectorGps, NeedsNoPlannerAndNobodyWhoPlans) {
  DirectorFlight flight;
  flight.director.set_guidance_problem("planner is silent");
  flight.take_off();
  ASSERT_TRUE(flight.director.fly_straight(7, {{{2, 0, 2}, {}}}, flight.now).ok());
  EXPECT_TRUE(flight.fly_until(Mode::kHover, 30.0));
  EXPECT_TRUE(flight.status().mission_done);
}

TEST(FlightDirectorGps, WhatTheLidarSeesOnTheWayEndsIt) {
  DirectorFlight flight;
  flight.take_off();
  ASSERT_TRUE(flight.director.fly_straight(7, {{{30, 0, 2}, {}}}, flight.now).ok());
  double nearest = 1e9;
  const Eigen::Vector2d mast(20.0, 0.2);
  const auto look = [&] {
    flight.director.set_obstacles(NearObstacles({mast, {22.0, 3.0}}), flight.now);
    nearest = std::min(nearest, (mast - flight.vehicle.p_WB.head<2>()).norm());
    return flight.mode() == Mode::kHover;
  };
  ASSERT_TRUE(flight.tick_until(look, 40.0));
  EXPECT_THAT(flight.transitions.back(), HasSubstr("m ahead on the way to waypoint 1"));
  flight.fly_for(5.0);
  look();
  EXPECT_GT(nearest, 0.25 + 0.25);
  EXPECT_LT(nearest, 1.0);
}

TEST(FlightDirectorGps, ALidarThatDiesOnTheWayEndsItToo) {
  DirectorFlight flight;
  flight.take_off();
  flight.director.set_obstacles(NearObstacles(), flight.now);
  ASSERT_TRUE(flight.director.fly_straight(7, {{{30, 0, 2}, {}}}, flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 2.0));
  EXPECT_THAT(flight.transitions.back(), HasSubstr("the LIDAR has seen nothing for 0.5"));
}

TEST(FlightDirectorGps, ReturnsStraightAndLands) {
  DirectorFlight flight;
  flight.director.set_guidance_problem("planner is silent");
  flight.take_off();
  const Eigen::Vector3d pad = flight.status().home;
  ASSERT_TRUE(flight.director.fly_straight(7, {{{10, 5, 4}, {}}}, flight.now).ok());
  flight.fly_for(8.0);
  ASSERT_EQ(flight.mode(), Mode::kGpsGuidance);
  ASSERT_GT(flight.vehicle.p_WB.head<2>().norm(), 1.0);
  ASSERT_TRUE(flight.director.request(Request::go_back(), flight.now).ok());
  EXPECT_EQ(flight.mode(), Mode::kGpsGuidance);
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 60.0));
  EXPECT_LT((flight.vehicle.p_WB - pad).norm(), 0.15);
  EXPECT_FALSE(flight.status().mission_done);
  EXPECT_THAT(flight.transitions, ::testing::Contains("GPS Guidance -> Land: back home"));
}

}  // namespace
}  // namespace swiftlet::test
