// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mission_runner.hpp"

#include "director_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::HasSubstr;
using Kind = MissionItem::Kind;
using State = MissionRunner::State;

MissionItem at(double x, double y, double z, double hold = 0.0) {
  MissionItem item;
  item.place.position = {x, y, z};
  item.hold = hold;
  return item;
}
MissionItem on_earth(const GlobalPosition& place, double altitude) {
  MissionItem item;
  item.global = GlobalWaypoint{place.latitude, place.longitude, altitude};
  return item;
}
MissionItem of(Kind kind) {
  MissionItem item;
  item.kind = kind;
  return item;
}
MissionItem takeoff(double altitude) {
  MissionItem item = of(Kind::kTakeoff);
  item.altitude = altitude;
  return item;
}
MissionItem claw(bool open) {
  MissionItem item = of(Kind::kClaw);
  item.open = open;
  return item;
}

/// A flight with a mission, ticked together.
struct MissionFlight : DirectorFlight {
  MissionFlight() {
    planner = [this, answered = Time{}](const PlanGoal& goal) mutable {
      if (std::exchange(answered, goal.identity) == goal.identity) return;
      const double way = (goal.waypoint.position - vehicle.p_WB).norm();
      director.set_plan(leads_to_goal(goal, 1.5 + way));
    };
  }

  void load(const std::vector<MissionItem>& items) {
    const Status loaded = runner.load(items, director);
    ASSERT_TRUE(loaded.ok()) << loaded.error().reason;
  }
  Result<Acceptance> start(std::size_t item = 0) {
    return runner.start(item, director, origin, now);
  }
  State state() const { return runner.memory().state; }
  bool run_until(const std::function<bool()>& condition, double limit_s = 60.0) {
    return tick_until(
        [&] {
          runner.tick(director, origin, now);
          return condition();
        },
        limit_s);
  }
  bool run_to(State wanted, double limit_s = 120.0) {
    return run_until([&] { return state() == wanted; }, limit_s);
  }

  MissionRunner runner;
  std::optional<LocalOrigin> origin;
};

TEST(MissionRunner, FliesTakeoffWaypointsHoldAndLanding) {
  MissionFlight flight;
  flight.fly_for(0.05);
  flight.load({takeoff(1.2), at(1, 0, 1.2), at(1, 1, 1.5, 2.0), at(0, 1, 1.2), of(Kind::kLand)});
  EXPECT_THAT(flight.start().error().reason, HasSubstr("not armed"));
  EXPECT_EQ(flight.state(), State::kReady);
  ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  ASSERT_TRUE(flight.start().ok());
  EXPECT_EQ(*flight.start(), Acceptance::kUnchanged);
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 2; }));
  ASSERT_TRUE(flight.run_until([&] { return flight.mode() == Mode::kHover; }));
  const Time arrived = flight.now;
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(1, 1, 1.5)).norm(), 0.15);
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 3; }));
  EXPECT_NEAR(to_seconds(flight.now - arrived), 2.0, 0.05);
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_EQ(flight.mode(), Mode::kGrounded);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(0, 1, 0)).norm(), 0.2);
}

TEST(MissionRunner, WaypointsInARowAreOneFlight) {
  MissionFlight flight;
  flight.take_off();
  flight.load({at(1, 0, 1.2), at(1, 1, 1.2), at(0, 1, 1.2)});
  flight.transitions.clear();
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_THAT(flight.transitions,
              testing::ElementsAre("Indoor Navigation -> Hover: mission finished"));
}

TEST(MissionRunner, PausedItGoesOnWhereItWas) {
  MissionFlight flight;
  flight.take_off();
  flight.load({at(1, 0, 1.2), at(2, 0, 1.2), at(3, 0, 1.2)});
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 1; }));
  flight.fly_for(0.3);
  ASSERT_TRUE(flight.runner.pause(flight.director, flight.now).ok());
  EXPECT_EQ(*flight.runner.pause(flight.director, flight.now), Acceptance::kUnchanged);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  ASSERT_TRUE(flight.run_until([&] { return flight.vehicle.v_WB_W.norm() < 1e-3; }));
  EXPECT_EQ(flight.state(), State::kPaused);
  const double stopped_at = flight.vehicle.p_WB.x();
  EXPECT_LT(stopped_at, 2.0);
  double least = stopped_at;
  flight.plan = {};  // it was not flown to its end
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] {
    least = std::min(least, flight.vehicle.p_WB.x());
    return flight.state() == State::kDone;
  }));
  EXPECT_GT(least, stopped_at - 0.05) << "it did not begin anew";
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(3, 0, 1.2)).norm(), 0.15);
}

TEST(MissionRunner, APilotAndAFailureInterruptItWithTheirReasons) {
  MissionFlight flight;
  flight.take_off();
  flight.load({at(1, 0, 1.2), at(2, 0, 1.2), at(3, 0, 1.2)});
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 1; }));
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  ASSERT_TRUE(flight.run_to(State::kPaused, 1.0));
  EXPECT_EQ(flight.runner.memory().reason, "hover requested");
  EXPECT_EQ(flight.runner.memory().item, 1U);

  flight.planner = [&flight](const PlanGoal& goal) {
    flight.director.set_plan({goal.identity, {}, false, "no path", "a wall"});
  };
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_to(State::kPaused, 5.0));
  EXPECT_EQ(flight.runner.memory().reason, "no path to waypoint 2: a wall")
      << "numbers of the mission";
  EXPECT_EQ(flight.mode(), Mode::kHover);
}

TEST(MissionRunner, FromTheMapOutToTheEarthAndBack) {
  MissionFlight flight;
  flight.take_off();
  const LocalOrigin origin({47.4, 8.5, 400.0});
  const Eigen::Vector3d outside(20.0, 5.0, 6.0);
  const std::vector<MissionItem> items{at(1, 0, 1.2), on_earth(origin.to_global(outside), 6.0),
                                       at(18, 5, 2.0), of(Kind::kReturn)};
  flight.load(items);
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_to(State::kPaused, 20.0));
  EXPECT_THAT(flight.runner.memory().reason, HasSubstr("where on Earth the map is"));
  flight.origin = origin;
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] { return flight.mode() == Mode::kGpsGuidance; }));
  ASSERT_TRUE(flight.run_until([&] { return flight.mode() == Mode::kIndoorNavigation; }));
  EXPECT_LT((flight.vehicle.p_WB - outside).norm(), 0.2);
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 3; }));
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(18, 5, 2)).norm(), 0.2);
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_LT(flight.vehicle.p_WB.norm(), 0.2);
}

TEST(MissionRunner, FromTheEarthItReturnsStraight) {
  MissionFlight flight;
  flight.take_off();
  flight.planner = nullptr;  // there is no map out there
  flight.director.set_guidance_problem("planner is silent");
  flight.origin = LocalOrigin({47.4, 8.5, 400.0});
  const Eigen::Vector3d far(15.0, 8.0, 4.0);
  MissionItem hold = of(Kind::kHold);
  hold.hold = 1.0;
  flight.load({on_earth(flight.origin->to_global(far), 4.0), hold, of(Kind::kReturn)});
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 2; }));
  EXPECT_LT((flight.vehicle.p_WB - far).norm(), 0.2);
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_EQ(flight.mode(), Mode::kGrounded);
  EXPECT_LT(flight.vehicle.p_WB.norm(), 0.2);
}

TEST(MissionRunner, AWaypointsSpeedIsKept) {
  MissionFlight flight;
  flight.take_off();
  flight.origin = LocalOrigin({47.4, 8.5, 400.0});
  MissionItem slow = on_earth(flight.origin->to_global({15.0, 0.0, 1.2}), 1.2);
  slow.place.speed = 0.8;
  flight.load({slow});
  ASSERT_TRUE(flight.start().ok());
  double fastest = 0.0;
  ASSERT_TRUE(flight.run_until([&] {
    fastest = std::max(fastest, flight.vehicle.v_WB_W.head<2>().norm());
    return flight.state() == State::kDone;
  }));
  EXPECT_NEAR(fastest, 0.8, 0.01);
}

TEST(MissionRunner, TheClawIsWaitedForAndNotForEver) {
  MissionFlight flight;
  flight.take_off();
  flight.load({claw(true), claw(false)});
  flight.runner.set_claw(ClawProgress::kOpen);  // of some time before
  ASSERT_TRUE(flight.start().ok());
  EXPECT_EQ(flight.runner.memory().claw_open, true);
  flight.runner.tick(flight.director, {}, flight.now);
  EXPECT_EQ(flight.runner.memory().item, 0U);
  flight.runner.set_claw(ClawProgress::kOpen);
  flight.runner.tick(flight.director, {}, flight.now);
  EXPECT_EQ(flight.runner.memory().item, 1U);
  EXPECT_EQ(flight.runner.memory().claw_open, false);
  const Time begin = flight.now;
  ASSERT_TRUE(flight.run_to(State::kPaused, 10.0));
  EXPECT_NEAR(to_seconds(flight.now - begin), 5.0, 0.05);
  EXPECT_THAT(flight.runner.memory().reason, HasSubstr("the claw does not close within 5.0 s"));
}

TEST(MissionRunner, AClawsFaultOfBeforeIsForgivenAndOneThatStaysIsNot) {
  MissionFlight flight;
  flight.take_off();
  flight.load({claw(true), claw(false)});
  ASSERT_TRUE(flight.start().ok());
  flight.runner.set_claw(ClawProgress::kFault);  // on its way while the command was given
  flight.runner.tick(flight.director, {}, flight.now);
  EXPECT_EQ(flight.state(), State::kFlying);
  flight.runner.set_claw(ClawProgress::kOpen);
  flight.runner.tick(flight.director, {}, flight.now);
  EXPECT_EQ(flight.runner.memory().item, 1U);
  flight.runner.set_claw(ClawProgress::kFault);
  const Time begin = flight.now;
  ASSERT_TRUE(flight.run_to(State::kPaused, 3.0));
  EXPECT_NEAR(to_seconds(flight.now - begin), 0.5, 0.05);
  EXPECT_THAT(flight.runner.memory().reason, HasSubstr("the claw does not close: it has a fault"));
}

TEST(MissionRunner, WhatMakesNoSenseIsRefusedAsAWhole) {
  MissionFlight flight;
  FlightDirector::Params params = settled();
  params.fence.radius = 10.0;
  FlightDirector fenced(params);
  MissionRunner& runner = flight.runner;
  ASSERT_TRUE(runner.load({at(1, 0, 1)}, fenced).ok());
  const auto refusal = [&](const std::vector<MissionItem>& items) {
    const Status loaded = runner.load(items, fenced);
    EXPECT_EQ(runner.items().size(), 1U) << "the one that there was";
    return loaded.ok() ? "" : loaded.error().reason;
  };
  EXPECT_THAT(refusal({}), HasSubstr("it has no items"));
  EXPECT_THAT(refusal({at(1, 0, 1), at(NAN, 0, 1)}), HasSubstr("item 2: it is not a place"));
  EXPECT_THAT(refusal({at(1, 0, 1), at(12, 0, 1)}), HasSubstr("item 2: "));
  EXPECT_THAT(refusal({at(1, 0, 1, -1.0)}), HasSubstr("item 1: a hold of -1 s"));
  EXPECT_THAT(refusal({on_earth({95.0, 0.0, 0.0}, 5.0)}), HasSubstr("no place on Earth"));
  EXPECT_THAT(refusal({takeoff(NAN)}), HasSubstr("item 1: an altitude"));
  EXPECT_THAT(refusal(std::vector<MissionItem>(1001, at(1, 0, 1))), HasSubstr("1000 are the most"));
  MissionItem fast = at(1, 0, 1);
  fast.place.speed = 2.0;
  EXPECT_THAT(refusal({fast}), HasSubstr("only a waypoint on Earth"));
}

TEST(MissionRunner, NothingIsChangedWhileItIsFlown) {
  MissionFlight flight;
  flight.take_off();
  flight.load({at(1, 0, 1.2), at(2, 0, 1.2)});
  EXPECT_THAT(flight.start(3).error().reason, HasSubstr("there is no item 3, the mission has 2"));
  EXPECT_THAT(flight.runner.pause(flight.director, flight.now).error().reason,
              HasSubstr("no mission is being flown"));
  ASSERT_TRUE(flight.start(2).ok());
  EXPECT_EQ(flight.runner.memory().item, 1U);
  EXPECT_THAT(flight.runner.load({at(5, 0, 1.2)}, flight.director).error().reason,
              HasSubstr("another one is being flown"));
  EXPECT_THAT(flight.runner.clear().error().reason, HasSubstr("it is being flown"));
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_TRUE(flight.runner.clear().ok());
  EXPECT_THAT(flight.start().error().reason, HasSubstr("there is none"));
}

TEST(MissionRunner, AnotherRunnerGoesOnAndWithoutItsItemsItSaysSo) {
  MissionFlight flight;
  flight.take_off();
  flight.load({at(1, 0, 1.2), at(2, 0, 1.2), at(2, 1, 1.2)});
  ASSERT_TRUE(flight.start().ok());
  ASSERT_TRUE(flight.run_until([&] { return flight.runner.memory().item == 1; }));
  MissionRunner other;
  other.restore(flight.runner.memory(), flight.runner.items());
  MissionRunner poor;
  poor.restore(flight.runner.memory(), {});
  flight.runner = other;
  ASSERT_TRUE(flight.run_to(State::kDone));
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(2, 1, 1.2)).norm(), 0.15);
  poor.tick(flight.director, {}, flight.now);
  EXPECT_EQ(poor.memory().state, State::kPaused);
  EXPECT_THAT(poor.memory().reason, HasSubstr("not handed over"));
}

}  // namespace
}  // namespace swiftlet::test
