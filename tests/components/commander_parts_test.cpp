// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "components/commander/answered_commands.hpp"
#include "components/commander/attendance.hpp"
#include "components/commander/authority_desk.hpp"
#include "components/commander/director_params.hpp"
#include "components/commander/limits_message.hpp"
#include "components/commander/state_message.hpp"
#include "components/runtime/message.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using swiftlet_msgs::msg::ComponentStatus;
using ::testing::HasSubstr;

ComponentStatus status(const std::string& component, const std::string& instance, bool active,
                       std::uint32_t term, const std::string& problem = "", bool blocked = false) {
  ComponentStatus status;
  status.component_name(component);
  status.instance(instance);
  status.active(active);
  status.term(term);
  status.period(0.1);
  if (!problem.empty()) status.problems({problem});
  status.blocked(blocked);
  return status;
}

TEST(AnsweredCommands, TheLastOnesAreKnownToAStandbyToo) {
  const auto answer = [](std::size_t id) {
    swiftlet_msgs::msg::CommandAck message;
    message.id(std::to_string(id));
    message.accepted(id % 2 == 0);
    return message;
  };
  AnsweredCommands answered, standby;
  EXPECT_EQ(answered.find("0"), nullptr);
  for (std::size_t id = 0; id <= AnsweredCommands::kMost; ++id) {
    EXPECT_EQ(answered.add(answer(id)).id(), std::to_string(id));
  }
  swiftlet_msgs::msg::CommanderState state;
  answered.write(state);
  standby.restore(state);
  for (const AnsweredCommands& known : {answered, standby}) {
    EXPECT_EQ(known.find("0"), nullptr) << "is the oldest of one too many";
    ASSERT_NE(known.find("1"), nullptr);
    EXPECT_FALSE(known.find("1")->accepted());
    ASSERT_NE(known.find("64"), nullptr);
    EXPECT_TRUE(known.find("64")->accepted());
  }
}

TEST(AuthorityDesk, SticksThatNobodyTouchesTakeNoControl) {
  AuthorityDesk desk(30s);
  const auto sticks = [](const std::string& station, float forward) {
    swiftlet_msgs::msg::ManualControl message;
    message.station(station);
    message.forward(forward);
    return message;
  };
  EXPECT_TRUE(desk.admit_sticks(sticks("base", 0.0f), Time(100s))) << "they are there";
  EXPECT_EQ(desk.holder(Time(100s)), "");
  EXPECT_TRUE(desk.admit_sticks(sticks("base", 0.5f), Time(101s)));
  EXPECT_EQ(desk.holder(Time(101s)), "base");
  EXPECT_FALSE(desk.admit_sticks(sticks("tablet", 0.5f), Time(102s)));
  EXPECT_FALSE(desk.admit_sticks(sticks("tablet", 0.0f), Time(102s)));
  EXPECT_TRUE(desk.admit_sticks(sticks("", 1.0f), Time(103s)))
      << "the vehicle's own remote control";
  EXPECT_EQ(desk.holder(Time(103s)), "base");
  EXPECT_TRUE(desk.admit_sticks(sticks("base", 0.0f), Time(130s)));
  EXPECT_EQ(desk.holder(Time(155s)), "base") << "who has control shows that it is there";
}

TEST(AuthorityDesk, OfTwoWhoMaySteerTheOneThatMovesHisSticksDoes) {
  AuthorityDesk desk(30s);
  Time now(100s);
  const auto steers = [&](const std::string& station, float forward) {
    swiftlet_msgs::msg::ManualControl message;
    message.station(station);
    message.forward(forward);
    now += 10ms;
    return desk.admit_sticks(message, now);
  };
  EXPECT_TRUE(steers("", 0.0f));
  EXPECT_FALSE(steers("base", 0.0f)) << "two that lie still: the first";
  EXPECT_TRUE(steers("base", 0.5f)) << "the remote control lies on the table, switched on";
  EXPECT_FALSE(steers("", 0.0f));
  EXPECT_TRUE(steers("", -0.5f)) << "and is taken up";
  EXPECT_FALSE(steers("base", 0.5f));
  EXPECT_TRUE(steers("", 0.0f));
  EXPECT_FALSE(steers("base", 0.0f));
  now += 200ms;
  EXPECT_TRUE(steers("base", 0.0f)) << "it was switched off";
  EXPECT_FALSE(steers("tablet", 0.5f)) << "who has no control does not, and keeps nobody from it";
  EXPECT_TRUE(steers("base", 0.0f));
  EXPECT_FALSE(steers("", 0.004f)) << "a joystick that is plugged in and lies there";
  EXPECT_FALSE(steers("", std::numeric_limits<float>::quiet_NaN()));
  desk.set_dead_band(0.15);
  EXPECT_FALSE(steers("", 0.1f)) << "a worn one";
}

TEST(AuthorityDesk, OnlyWhoHasControlIsMissed) {
  using Link = AuthorityDesk::Link;
  AuthorityDesk desk(30s);
  const auto heard = [&desk](const char* station, Time now, bool stays = true,
                             double period = 0.25) {
    ComponentStatus heartbeat;
    heartbeat.instance(station);
    heartbeat.period(period);
    heartbeat.active(stays);
    return desk.hear(heartbeat, now);
  };
  EXPECT_EQ(heard("tablet", Time(100s)), Link::kHeard) << "nobody has control";
  ASSERT_TRUE(desk.admit("base", Time(100s)).ok());
  EXPECT_TRUE(desk.link_is_of_others(Time(100s)))
      << "base commands by verbs: it was never there to be missed";
  EXPECT_EQ(heard("tablet", Time(101s)), Link::kOfOthers);
  EXPECT_EQ(heard("base", Time(101s), true, 0.0), Link::kOfOthers) << "it promises nothing";
  EXPECT_TRUE(desk.link_is_of_others(Time(101s)));
  EXPECT_EQ(heard("base", Time(101s)), Link::kHeard);
  EXPECT_FALSE(desk.link_is_of_others(Time(101s)));
  EXPECT_EQ(heard("tablet", Time(102s), false), Link::kOfOthers);
  EXPECT_EQ(heard("base", Time(102s), false), Link::kLeft);
  EXPECT_EQ(heard("tablet", Time(133s)), Link::kHeard) << "base has been away for too long";

  ASSERT_TRUE(desk.admit("base", Time(140s)).ok());
  EXPECT_EQ(heard("base", Time(140s)), Link::kHeard);
  swiftlet_msgs::msg::ModeCommand give;
  give.command(swiftlet_msgs::msg::ModeCommand_Constants::CONTROL_GIVE);
  give.station("base");
  give.successor("tablet");
  ASSERT_TRUE(desk.carry_out(give, Time(141s))->ok());
  EXPECT_FALSE(desk.link_is_of_others(Time(141s)));
  EXPECT_EQ(heard("base", Time(142s)), Link::kHeard) << "until who was given control is there";
  ASSERT_TRUE(desk.admit("tablet", Time(143s)).ok());
  EXPECT_TRUE(desk.link_is_of_others(Time(143s))) << "it commands by verbs";
  EXPECT_EQ(heard("base", Time(144s)), Link::kOfOthers);
}

TEST(AuthorityDesk, WhatIsAboutControlIsCarriedOutByItAlone) {
  using namespace swiftlet_msgs::msg::ModeCommand_Constants;
  AuthorityDesk desk(30s);
  const auto ask = [&](std::uint8_t what, const std::string& station,
                       const std::string& successor = "") {
    swiftlet_msgs::msg::ModeCommand command;
    command.command(what);
    command.station(station);
    command.successor(successor);
    return desk.carry_out(command, Time(100s));
  };
  EXPECT_FALSE(ask(LAND, "base")) << "is none of its business";
  EXPECT_EQ(desk.holder(Time(100s)), "");

  ASSERT_TRUE(ask(CONTROL_GIVE, "base", "tabelt")->ok());
  EXPECT_EQ(desk.holder(Time(100s)), "tabelt");
  EXPECT_FALSE(desk.admit("base", Time(100s)).ok()) << "it has given control away";
  EXPECT_TRUE(ask(CONTROL_TAKE, "base")->ok()) << "nobody has that name";
  EXPECT_EQ(desk.holder(Time(100s)), "base");

  for (const auto what : {CONTROL_TAKE, CONTROL_RELEASE, CONTROL_GIVE}) {
    const auto answer = ask(what, "tablet", "tablet");
    ASSERT_FALSE(answer->ok());
    EXPECT_THAT(answer->error().reason,
                testing::MatchesRegex("control (take|release|give) refused: station 'base' has.*"));
  }
  EXPECT_EQ(ask(CONTROL_GIVE, "base")->error().reason, "control give refused: give it to whom?");
  EXPECT_TRUE(ask(CONTROL_RELEASE, "base")->ok());
  EXPECT_EQ(desk.holder(Time(100s)), "");
}

TEST(Attendance, WhoWasNeverThereIsNotMissed) {
  const Attendance attendance;
  EXPECT_EQ(attendance.problem(Time(100s)), "");
  EXPECT_EQ(attendance.failure("planner", Time(100s)), "");
}

TEST(Attendance, OneWithoutWhomNothingFliesMustHaveSaidHowItIs) {
  Attendance attendance;
  EXPECT_THAT(attendance.absence("flight_controller", Time(10s)), HasSubstr("has not said how"));
  attendance.heard_status(status("flight_controller", "a", false, 0), Time(10s));
  EXPECT_NE(attendance.absence("flight_controller", Time(10s)), "") << "one that stands by is none";
  attendance.heard_status(status("flight_controller", "b", true, 1), Time(10s));
  EXPECT_EQ(attendance.absence("flight_controller", Time(11s)), "");
  EXPECT_NE(attendance.absence("flight_controller", Time(11100ms)), "");
}

TEST(Attendance, ThreePeriodsOfSilenceAreAFailure) {
  Attendance attendance;
  attendance.heard_status(status("planner", "a", true, 1), Time(10s));
  attendance.heard_alive(status("planner", "a", true, 1), Time(11s));
  EXPECT_EQ(attendance.failure("planner", Time(11300ms)), "");
  EXPECT_EQ(attendance.failure("planner", Time(11310ms)), "the planner fell silent 0.31 s ago");
  EXPECT_EQ(attendance.failure("commander", Time(11310ms)), "");
}

TEST(Attendance, AStandbyIsGivenTheTimeToTakeOver) {
  Attendance attendance;
  attendance.heard_status(status("planner", "a", true, 1), Time(10s));
  attendance.heard_status(status("planner", "b", false, 0), Time(10s));
  for (Time now(10s); now < Time(10500ms); now += 100ms) {
    attendance.heard_alive(status("planner", "b", false, 0), now);
  }
  EXPECT_EQ(attendance.failure("planner", Time(10500ms)), "");
  attendance.heard_alive(status("planner", "b", true, 2), Time(10500ms));
  EXPECT_EQ(attendance.failure("planner", Time(10700ms)), "") << "there is a successor";
  EXPECT_EQ(attendance.problem(Time(10700ms)), "") << "and the dead one is not missed";
  EXPECT_THAT(attendance.failure("planner", Time(11500ms)), HasSubstr("fell silent 1.00 s ago"));
}

TEST(Attendance, ProblemsThatOthersReportKeepFromArming) {
  Attendance attendance;
  attendance.heard_status(status("estimator", "a", true, 1, "imu0: 300 Hz, 1000 Hz are usual"),
                          Time(10s));
  attendance.heard_alive(status("estimator", "a", true, 1), Time(10100ms));
  EXPECT_EQ(attendance.problem(Time(10100ms)), "estimator: imu0: 300 Hz, 1000 Hz are usual")
      << "a sign of life says nothing of problems";
  EXPECT_EQ(attendance.failure("estimator", Time(10100ms)), "") << "slow, but it works";
  attendance.heard_status(status("estimator", "a", true, 1), Time(10300ms));
  EXPECT_EQ(attendance.problem(Time(10300ms)), "");
}

TEST(Attendance, WhoLeftLongAgoIsMissedInFlightAlone) {
  Attendance attendance;
  attendance.heard_status(status("explorer", "b", true, 1), Time(5s));
  attendance.heard_status(status("planner", "a", true, 1), Time(10s));
  attendance.forget_who_left(Time(17s));  // and takes off
  EXPECT_THAT(attendance.problem(Time(17s)), HasSubstr("planner: silent for 7.0 s"));
  EXPECT_THAT(attendance.problem(Time(25s)), HasSubstr("planner: silent for 15.0 s"));
  attendance.forget_who_left(Time(30s));  // on the ground again
  EXPECT_EQ(attendance.problem(Time(30s)), "");
  EXPECT_THAT(attendance.failure("planner", Time(30s)), HasSubstr("fell silent 20.00 s ago"))
      << "what needs it is refused all the same";
  attendance.heard_alive(status("planner", "a", true, 1), Time(31s));
  EXPECT_THAT(attendance.problem(Time(34s)), HasSubstr("planner: silent for 3.0 s"));
}

TEST(Attendance, WhoIsBlockedForHalfASecondHasFailed) {
  Attendance attendance;
  const auto heard = [&](Time now, bool blocked) {
    const char* problem = blocked ? "odometry: silent for 0.20 s" : "";
    attendance.heard_status(status("planner", "a", true, 1, problem, blocked), now);
  };
  heard(Time(10s), true);
  heard(Time(10200ms), false);
  heard(Time(10400ms), true);
  heard(Time(10700ms), true);
  EXPECT_EQ(attendance.failure("planner", Time(10900ms)), "")
      << "whoever should write the odometry may have a successor";
  heard(Time(10910ms), true);
  EXPECT_EQ(attendance.failure("planner", Time(10910ms)),
            "the planner cannot work: odometry: silent for 0.20 s");
}

TEST(Attendance, WhoIsSilentIsNamedBeforeWhoIsBlockedByIt) {
  Attendance attendance;
  attendance.heard_status(status("lidar_mapper", "a", true, 1), Time(10s));
  for (Time now(10s); now <= Time(12s); now += 100ms) {
    attendance.heard_status(status("planner", "b", true, 1, "map: silent for 1.34 s", true), now);
  }
  const std::array guides{"planner", "lidar_mapper"};
  EXPECT_THAT(attendance.failure("planner", Time(12s)), testing::HasSubstr("cannot work: map"));
  EXPECT_EQ(attendance.failure_of_any(guides, Time(12s)),
            "the lidar_mapper fell silent 2.00 s ago");
  attendance.heard_status(status("lidar_mapper", "a", true, 1), Time(12s));
  EXPECT_THAT(attendance.failure_of_any(guides, Time(12s)), testing::HasSubstr("cannot work: map"));
}

TEST(Attendance, WhoWasStartedAgainCountsWhateverTheDeadOneWas) {
  // It knows nothing of the terms before it, and its name may come before or behind.
  for (const char* reborn : {"a", "c"}) {
    Attendance attendance;
    attendance.heard_status(status("flight_controller", "b", true, 2), Time(10s));
    for (Time now(11s); now <= Time(12s); now += 100ms) {
      attendance.heard_status(status("flight_controller", reborn, true, 1), now);
    }
    EXPECT_EQ(attendance.absence("flight_controller", Time(12s)), "") << reborn;
    EXPECT_EQ(attendance.failure("flight_controller", Time(12s)), "") << reborn;
    EXPECT_EQ(attendance.problem(Time(12s)), "") << reborn;
  }
}

FlightDirector::State some_state() {
  FlightDirector::State state;
  state.machine = {Mode::kIndoorNavigation, true, false, 1.25, 77};
  state.takeoff_point = {1.0, 2.0, 3.0};
  const auto plan = [](Time start) {
    return *minimum_snap(start, FlatReference(), {{Eigen::Vector3d(1, 2, 1), 0.5}}, {3.0});
  };
  state.simple = FlightReference::move(Time(5s), {0, 0, 0}, {0, 0, 1}, 0.3, {})->trajectory();
  state.active = plan(Time(6s));
  state.coming = {plan(Time(7s)), plan(Time(8s))};
  state.waypoints = {{Eigen::Vector3d(1, 2, 1), 0.5},
                     {Eigen::Vector3d(4, 5, 1), std::nullopt, 2.5}};
  state.waypoint = 1;
  state.goal = PlanGoal{Time(5500ms), state.waypoints[1]};
  state.waiting_since = Time(5600ms);
  state.refusal = "too fast";
  state.navigation = Situation::Navigation::kActive;
  state.cruise_altitude = 1.5;
  state.navigation_problem = "none";
  state.last_reason = "mission requested";
  return state;
}

/// As it comes out of a message that was on the wire.
FlightDirector::State sent(const FlightDirector::State& state) {
  const auto message = from_cdr<swiftlet_msgs::msg::CommanderState>(to_cdr(to_msg(state)));
  EXPECT_TRUE(message.ok());
  return from_msg(*message);
}

TEST(StateMessage, CarriesAllThatASuccessorNeeds) {
  const FlightDirector::State state = some_state();
  const FlightDirector::State copy = sent(state);
  EXPECT_FALSE(differs(state, copy));
  EXPECT_EQ(copy.takeoff_point, state.takeoff_point);
  ASSERT_EQ(copy.waypoints.size(), 2u);
  EXPECT_EQ(copy.waypoints[0].yaw, 0.5);
  EXPECT_EQ(copy.waypoints[0].speed, std::nullopt);
  EXPECT_EQ(copy.waypoints[1].yaw, std::nullopt);
  EXPECT_EQ(copy.waypoints[1].speed, 2.5);
  EXPECT_EQ(copy.waypoints[1].position, state.waypoints[1].position);
  EXPECT_EQ(copy.goal->waypoint.position, state.goal->waypoint.position);
  EXPECT_EQ(copy.cruise_altitude, 1.5);
  EXPECT_EQ(copy.navigation_problem, "none");
  for (Time now(5s); now < Time(12s); now += 70ms) {
    EXPECT_EQ(copy.simple.evaluate(now).position, state.simple.evaluate(now).position);
    EXPECT_EQ(copy.active->evaluate(now).velocity, state.active->evaluate(now).velocity);
    EXPECT_EQ(copy.coming[1].evaluate(now).yaw, state.coming[1].evaluate(now).yaw);
  }
}

TEST(StateMessage, AStateThatHasDecidedNothingStaysSo) {
  EXPECT_FALSE(differs(sent({}), {}));
  EXPECT_FALSE(sent({}).goal.has_value());
  EXPECT_FALSE(sent({}).active.has_value());
  EXPECT_TRUE(sent({}).simple.empty());
}

TEST(StateMessage, EveryDecisionMakesADifference) {
  const FlightDirector::State state = some_state();
  const auto noticed = [&](auto change) {
    FlightDirector::State other = state;
    change(other);
    return differs(state, other);
  };
  EXPECT_TRUE(noticed([](auto& s) { s.machine.mode = Mode::kHover; }));
  EXPECT_TRUE(noticed([](auto& s) { s.machine.armed = false; }));
  EXPECT_TRUE(noticed([](auto& s) { s.active.reset(); }));
  EXPECT_TRUE(noticed([](auto& s) { s.coming.pop_back(); }));
  EXPECT_TRUE(noticed([](auto& s) { s.waypoint = 0; }));
  EXPECT_TRUE(noticed([](auto& s) { s.goal.reset(); }));
  EXPECT_TRUE(noticed([](auto& s) { s.waiting_since.reset(); }));
  EXPECT_TRUE(noticed([](auto& s) { s.mission_done = true; }));
  EXPECT_TRUE(noticed([](auto& s) { s.last_reason = "other"; }));
}

TEST(LimitsMessage, SaysWhatTheDirectorHoldsFlightsTo) {
  Config config;
  config.set("fence_radius", "20");
  config.set("fence_height", "5");
  config.set("gps_speed", "2.5");
  config.set("takeoff_speed", "0.7");
  config.set("landing_speed", "0.3");
  config.set("vehicle_radius", "0.4");
  config.set("plan_margin", "0.2");
  config.set("endurance", "600");
  MissionRunner::Params runner;
  runner.most_items = 70;
  const auto limits = make_limits(config, read_director_params(config), runner);
  EXPECT_EQ(limits.fence_radius(), 20.0);
  EXPECT_EQ(limits.fence_height(), 5.0);
  EXPECT_EQ(limits.gps_speed(), 2.5);
  EXPECT_EQ(limits.climb_speed(), 0.7);
  EXPECT_EQ(limits.descent_speed(), 0.3);
  EXPECT_EQ(limits.clearance(), 0.4 + 0.2);
  EXPECT_EQ(limits.endurance(), 600.0);
  EXPECT_EQ(limits.most_items(), 70u);
  EXPECT_EQ(limits.low_battery(), FlightDirector::Params().low_battery);
  EXPECT_EQ(limits.gps_altitude(), FlightDirector::Params().gps_altitude);
}

}  // namespace
}  // namespace swiftlet
