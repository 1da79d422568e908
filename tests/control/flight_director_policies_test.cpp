// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// What watches over a flight: geofence, battery, link; and the way home.
#include <algorithm>
#include <cmath>
#include <string>

#include "director_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Demand = Situation::Demand;

TEST(FlightDirectorReturn, FliesHomeByPlansAndLands) {
  DirectorFlight flight;
  flight.answer_once();
  flight.take_off();
  const Eigen::Vector3d pad = flight.status().home;
  ASSERT_TRUE(flight.director.fly(1, {{{4, 3, 1.2}, {}}}, flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 20.0));
  ASSERT_TRUE(flight.director.request(Request::go_back(), flight.now).ok());
  EXPECT_EQ(flight.mode(), Mode::kIndoorNavigation);
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 40.0));
  EXPECT_LT((flight.vehicle.p_WB - pad).head<2>().norm(), 0.15);
  EXPECT_THAT(flight.transitions, Contains("Indoor Navigation -> Land: back home"));
}

TEST(FlightDirectorReturn, WithoutAWayItLandsWhereItIs) {
  DirectorFlight flight;
  flight.answer_once();
  flight.take_off();
  ASSERT_TRUE(flight.director.fly(1, {{{4, 3, 1.2}, {}}}, flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 20.0));
  flight.planner = [&](const PlanGoal& goal) {
    flight.director.set_plan({goal.identity, {}, false, "no path", "the door is closed"});
  };
  ASSERT_TRUE(flight.director.request(Request::go_back(), flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 20.0));
  EXPECT_THAT(flight.transitions,
              Contains("Indoor Navigation -> Land: no way home: no path to the take-off point: the "
                       "door is closed"));
  EXPECT_GT(flight.vehicle.p_WB.x(), 3.5);

  DirectorFlight alone;
  alone.take_off();
  alone.director.set_guidance_problem("planner is silent");
  EXPECT_EQ(alone.director.request(Request::go_back(), alone.now).error().reason,
            "return refused: planner is silent");
}

TEST(FlightDirectorBattery, ReturnsWhenLowAndLandsWhenCritical) {
  DirectorFlight flight;
  flight.answer_once();
  flight.director.set_battery(0.9);
  flight.take_off();
  ASSERT_TRUE(flight.director.fly(1, {{{4, 3, 1.2}, {}}}, flight.now).ok());
  flight.fly_for(2.0);
  flight.director.set_battery(0.19);
  flight.tick();
  EXPECT_EQ(flight.transitions.back(), "Indoor Navigation -> Indoor Navigation: battery low: 19 %");
  flight.fly_for(1.0);
  flight.director.set_battery(0.09);
  flight.tick();
  EXPECT_EQ(flight.transitions.back(), "Indoor Navigation -> Land: battery critical: 9 %");
  EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 20.0));
}

TEST(FlightDirectorBattery, SaysSoOnceAndThePilotHasTheLastWord) {
  DirectorFlight flight;
  flight.answer_once();
  flight.director.set_battery(0.9);
  flight.take_off();
  flight.director.set_battery(0.19);
  flight.fly_for(0.5);
  EXPECT_EQ(flight.mode(), Mode::kIndoorNavigation);
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  flight.director.set_battery(0.15);
  flight.fly_for(5.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  flight.director.set_battery(0.08);
  flight.fly_for(0.1);
  EXPECT_EQ(flight.mode(), Mode::kLand) << "worse is another matter";
  // And a pilot who steers keeps steering: sticks take over again at once.
  for (int k = 0; k < 200; ++k) {
    flight.director.set_sticks({0.0, 0.0, 0.6, 0.0, false}, flight.now);
    flight.tick();
  }
  EXPECT_EQ(flight.mode(), Mode::kManual);
}

TEST(FlightDirectorLink, AGroundStationThatWasThereIsMissed) {
  DirectorFlight flight;
  flight.answer_once();
  flight.director.set_link_heard(flight.now);
  flight.fly_for(20.0);  // it went away before the flight
  flight.take_off();
  flight.fly_for(10.0);
  EXPECT_EQ(flight.mode(), Mode::kHover) << "and is not missed in it";
  flight.director.set_link_heard(flight.now);
  flight.fly_for(4.9);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  flight.fly_for(0.2);
  EXPECT_EQ(flight.mode(), Mode::kIndoorNavigation);
  EXPECT_THAT(flight.transitions.back(), HasSubstr("no ground station for 5.0"));
  EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 40.0));
}

TEST(FlightDirectorLink, OneThatSaysThatItLeavesIsNotMissed) {
  DirectorFlight flight;
  flight.take_off();
  flight.director.set_link_heard(flight.now);
  flight.fly_for(1.0);
  flight.director.set_link_left();
  flight.fly_for(20.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
}

TEST(FlightDirectorLink, MayBeMissedWithoutConsequences) {
  FlightDirector::Params params;
  params.on_link_loss = Demand::kNone;
  DirectorFlight flight(params);
  flight.take_off();
  flight.director.set_link_heard(flight.now);
  flight.fly_for(20.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
}

FlightDirector::Params fenced(double radius, double height) {
  FlightDirector::Params params;
  params.fence = {radius, height};
  return params;
}

TEST(FlightDirectorFence, MissionsBeyondItAreRefusedAndTheWaypointNamed) {
  DirectorFlight flight(fenced(5.0, 3.0));
  flight.take_off();
  const auto refusal = [&](const Eigen::Vector3d& place) {
    const auto result = flight.director.fly(1, {{{1, 0, 1}, {}}, {place, {}}}, flight.now);
    return result.ok() ? "" : result.error().reason;
  };
  EXPECT_EQ(refusal({6.5, 0, 1}), "navigate refused: waypoint 2 is 1.5 m outside of the fence");
  EXPECT_EQ(refusal({1, 1, 4}), "navigate refused: waypoint 2 is 1.0 m above the fence");
  EXPECT_EQ(flight.director.fly_straight(1, {{{0, 7, 1}, {}}}, flight.now).error().reason,
            "gps refused: waypoint 1 is 2.0 m outside of the fence");
  EXPECT_EQ(refusal({3, 3, 2}), "");
}

TEST(FlightDirectorFence, APlanThatLeavesItIsNotFlown) {
  DirectorFlight flight(fenced(5.0, 0.0));
  flight.take_off();
  flight.planner = [&](const PlanGoal& goal) {
    // Around, through what is outside.
    const auto way =
        minimum_snap(flight.now + seconds(0.06), flight.last.setpoint.reference,
                     {{{7.0, 0.0, 1.2}, 0.0}, {goal.waypoint.position, 0.0}}, {5.0, 5.0});
    ASSERT_TRUE(way.ok());
    flight.director.set_plan({goal.identity, *way, false, "", ""});
  };
  ASSERT_TRUE(flight.director.fly(1, {{{0, 4, 1.2}, {}}}, flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_THAT(flight.transitions.back(), HasSubstr("outside of the fence"));
  EXPECT_LT(flight.vehicle.p_WB.head<2>().norm(), 0.1);
}

TEST(FlightDirectorFence, SticksAreStoppedAtIt) {
  for (int angle = 0; angle < 12; ++angle) {
    DirectorFlight flight(fenced(4.0, 2.0));
    flight.take_off();
    const double direction = angle * M_PI / 6.0;
    for (int k = 0; k < 1500; ++k) {
      flight.director.set_sticks({std::cos(direction), std::sin(direction), 0.3, 0.0, false},
                                 flight.now);
      flight.tick();
    }
    EXPECT_NEAR(flight.vehicle.p_WB.head<2>().norm(), 4.0, 0.05);
    EXPECT_LT(flight.vehicle.p_WB.head<2>().norm(), 4.0 + 0.01);
    EXPECT_NEAR(flight.altitude(), 2.0, 0.05);
    EXPECT_EQ(flight.mode(), Mode::kManual);
  }
}

TEST(FlightDirectorFence, WhoIsBlownOutComesBack) {
  DirectorFlight flight(fenced(4.0, 0.0));
  flight.answer_once();
  flight.take_off();
  flight.expect_steps = true;
  flight.can_climb = false;  // it does not follow its reference
  flight.vehicle.p_WB.x() = 4.2;
  flight.tick();
  EXPECT_EQ(flight.mode(), Mode::kHover) << "a little overshoot is none";
  flight.vehicle.p_WB.x() = 4.4;
  flight.tick();
  EXPECT_EQ(flight.transitions.back(), "Hover -> Indoor Navigation: 0.4 m outside of the fence");
}

}  // namespace
}  // namespace swiftlet::test
