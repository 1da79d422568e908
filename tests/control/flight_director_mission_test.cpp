// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Missions and plans: what the director does with a planner's answers, and without them.
#include <limits>

#include "control/flight_director.hpp"
#include "tests/control/director_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<MissionWaypoint> kWaypoints{
    {{2.0, 0.0, 1.2}, {}}, {{2.0, 3.0, 1.5}, {}}, {{0.0, 0.0, 1.2}, {}}};

/// In Hover, with a planner that answers each goal once.
struct Hovering : DirectorFlight {
  Hovering() {
    take_off();
    transitions.clear();
    answer_once();
  }
  void begin(std::uint64_t id = 1, const std::vector<MissionWaypoint>& waypoints = kWaypoints) {
    ASSERT_TRUE(director.fly(id, waypoints, now).ok());
    tick();
  }
  double speed() const { return last.setpoint.reference.velocity.norm(); }
  bool under_way() const { return speed() > 0.5; }
  bool get_under_way() {
    return tick_until([this] { return under_way(); });
  }
  PlanAnswer failed(const PlanGoal& goal) const {
    return {goal.identity, {}, false, "no path", "the door is closed"};
  }
  PlanAnswer brake(const PlanGoal& goal) const { return {goal.identity, {}, true, "no path", ""}; }
};

TEST(FlightDirectorMission, FliesThroughItsWaypointsAndRestsAtEach) {
  Hovering flight;
  flight.begin();
  std::vector<std::size_t> flown_to;
  std::vector<Vector3d> rests;
  for (int k = 0; k < 3000 && flight.mode() == Mode::kIndoorNavigation; ++k) {
    const auto status = flight.status();
    EXPECT_EQ(status.waypoint_count, 3u);
    EXPECT_FALSE(status.mission_done);
    if (flown_to.empty() || flown_to.back() != status.waypoint) {
      flown_to.push_back(status.waypoint);
      rests.push_back(flight.vehicle.p_WB);
      EXPECT_LT(flight.vehicle.v_WB_W.norm(), 1e-6);
    }
    flight.tick();
  }
  EXPECT_THAT(flown_to, ElementsAre(1u, 2u, 3u));
  EXPECT_LT((rests[1] - kWaypoints[0].position).norm(), 1e-6);
  EXPECT_LT((rests[2] - kWaypoints[1].position).norm(), 1e-6);
  EXPECT_THAT(flight.transitions, ElementsAre("Indoor Navigation -> Hover: mission finished"));
  EXPECT_TRUE(flight.status().mission_done);
  EXPECT_LT((flight.vehicle.p_WB - kWaypoints[2].position).norm(), 1e-6);
  // Flown again, it begins anew.
  flight.begin();
  EXPECT_FALSE(flight.status().mission_done);
  EXPECT_EQ(flight.status().waypoint, 1u);
}

TEST(FlightDirectorMission, HeightsThatCannotBeFlownAreRefused) {
  Hovering flight;
  const auto refusal = [&flight](double height) {
    const auto result = flight.director.fly(7, {{{2.0, 0.0, height}, {}}}, flight.now);
    return result.ok() ? "" : result.error().reason;
  };
  EXPECT_THAT(refusal(-1.0),
              HasSubstr("waypoint 1 is -1.00 m above the take-off point; 0.25 m are"));
  EXPECT_THAT(refusal(0.1), HasSubstr("the least"));
  EXPECT_THAT(refusal(90.0), HasSubstr("90.00 m above the take-off point; 10.00 m are the most"));
  EXPECT_EQ(flight.mode(), Mode::kHover);
  // On Earth it is the fence that says how high.
  EXPECT_TRUE(flight.director.fly_straight(8, {{{2.0, 0.0, 90.0}, {}}}, flight.now).ok());
}

TEST(FlightDirectorMission, WhoIsHeldUpByWhatNobodySeesDoesNotTryForEver) {
  Hovering flight;
  flight.ceiling_z = 2.4;
  flight.expect_steps = true;  // plans begin where the vehicle is, not where it should be
  flight.planner = [&flight, planned = Time{}](const PlanGoal& goal) mutable {
    if (flight.now - planned < std::chrono::milliseconds(200)) return;
    planned = flight.now;
    FlatReference from;
    from.position = flight.vehicle.p_WB;
    from.velocity = flight.vehicle.v_WB_W;
    const auto way = minimum_snap(flight.now, from, {{goal.waypoint.position, 0.0}}, {8.0});
    flight.director.set_plan({goal.identity, *way, false, "", ""});
  };
  flight.begin(9, {{{0.0, 0.0, 9.0}, {}}});
  ASSERT_TRUE(flight.tick_until([&flight] { return flight.vehicle.p_WB.z() > 2.3; }));
  const Time there = flight.now;
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 30.0));
  EXPECT_THAT(flight.transitions,
              ElementsAre(HasSubstr("no way was made to waypoint 1 for 10 s; what holds")));
  EXPECT_GT(to_seconds(flight.now - there), 5.0);
  EXPECT_LT(to_seconds(flight.now - there), 10.1);
  EXPECT_FALSE(flight.status().mission_done);
}

TEST(FlightDirectorMission, ReplansInFlightLeaveNoStep) {
  Hovering flight;
  int plans = 0;
  // Every 300 ms another way, each from the one before, and the fifth is flown to its end.
  flight.planner = [&, goal_of_plans = Time{}, left = 0](const PlanGoal& goal) mutable {
    if (std::exchange(goal_of_plans, goal.identity) != goal.identity) left = 5;
    const bool due = flight.now.time_since_epoch() % std::chrono::milliseconds(300) == Duration(0);
    if (!due || left == 0) return;
    --left;
    ++plans;
    flight.director.set_plan(flight.leads_to_goal(goal, 2.6));
  };
  flight.begin();
  EXPECT_TRUE(flight.fly_until(Mode::kHover, 40.0));
  EXPECT_TRUE(flight.status().mission_done);
  EXPECT_EQ(plans, 15);
}

TEST(FlightDirectorMission, WithoutAPathItHoversAndNamesTheWaypoint) {
  Hovering flight;
  auto answer = flight.planner;
  flight.planner = [&, answer](const PlanGoal& goal) {
    if (flight.status().waypoint == 2) {
      flight.director.set_plan(flight.failed(goal));
    } else {
      answer(goal);
    }
  };
  flight.begin();
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_THAT(flight.transitions,
              ElementsAre("Indoor Navigation -> Hover: no path to waypoint 2: the door is closed"));
  EXPECT_EQ(flight.status().reason, "no path to waypoint 2: the door is closed");
  EXPECT_FALSE(flight.status().mission_done);
  EXPECT_FALSE(flight.last.goal.has_value()) << "the planner is let go";
  EXPECT_LT((flight.vehicle.p_WB - kWaypoints[0].position).norm(), 1e-6);
}

TEST(FlightDirectorMission, AFailureInFlightBrakesSmoothlyIntoHover) {
  Hovering flight;
  flight.begin();
  ASSERT_TRUE(flight.get_under_way());
  flight.director.set_plan(flight.failed(*flight.last.goal));
  flight.tick();
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_TRUE(flight.under_way()) << "braking, not stopped at once";
  flight.fly_for(3.0);
  EXPECT_EQ(flight.last.setpoint.reference.velocity, Vector3d::Zero());
}

TEST(FlightDirectorMission, APlannerThatIsSilentEndsInHover) {
  Hovering flight;
  flight.planner = nullptr;
  const Time begin = flight.now;
  flight.begin();
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_NEAR(to_seconds(flight.now - begin), 2.0, 0.05);
  EXPECT_THAT(flight.status().reason, HasSubstr("no plan to waypoint 1 within 2.0 s; is the "
                                                "planner running?"));
}

TEST(FlightDirectorMission, BrakeStopsAndTheNextPlanLeadsOn) {
  Hovering flight;
  flight.begin(1, {kWaypoints[0]});
  ASSERT_TRUE(flight.get_under_way());
  const PlanGoal goal = *flight.last.goal;
  flight.director.set_plan(flight.brake(goal));
  flight.tick();
  EXPECT_TRUE(flight.under_way()) << "braking, not stopped at once";
  ASSERT_TRUE(flight.tick_until([&] { return flight.speed() == 0.0; }));
  ASSERT_LT(flight.vehicle.p_WB.x(), 1.9);
  // A planner may think nearly as long as it is given, from rest on.
  flight.fly_for(1.9);
  EXPECT_EQ(flight.mode(), Mode::kIndoorNavigation);
  EXPECT_EQ(flight.last.goal->identity, goal.identity);
  flight.plan = {};
  flight.director.set_plan(flight.leads_to_goal(goal));
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_TRUE(flight.status().mission_done);
}

TEST(FlightDirectorMission, APlannerThatOnlyBrakesEndsInHover) {
  Hovering flight;
  flight.begin();
  ASSERT_TRUE(flight.get_under_way());
  flight.planner = [&](const PlanGoal& goal) { flight.director.set_plan(flight.brake(goal)); };
  EXPECT_TRUE(flight.fly_until(Mode::kHover, 5.0));
  EXPECT_THAT(flight.status().reason, HasSubstr("no plan to waypoint 1"));
}

TEST(FlightDirectorMission, BrakeAndPlanInOneTickAreTakenInTheirOrder) {
  Hovering flight;
  flight.begin(1, {kWaypoints[0]});
  ASSERT_TRUE(flight.get_under_way());
  const PlanGoal goal = *flight.last.goal;
  // The plan continues the way that was braked from: its first moments still do.
  flight.director.set_plan(flight.brake(goal));
  flight.director.set_plan(flight.leads_to_goal(goal));
  flight.expect_steps = true;
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_TRUE(flight.status().mission_done) << flight.status().reason;
}

TEST(FlightDirectorMission, AnswersToAnotherGoalAreIgnored) {
  Hovering flight;
  flight.begin();
  const PlanGoal old = *flight.last.goal;
  ASSERT_TRUE(flight.tick_until([&] { return flight.status().waypoint == 2; }));
  ASSERT_EQ(flight.mode(), Mode::kIndoorNavigation);
  flight.director.set_plan(flight.failed(old));
  flight.director.set_plan(flight.brake(old));
  PlanAnswer late{old.identity, flight.plan, false, "", ""};
  flight.director.set_plan(late);
  flight.tick();
  EXPECT_EQ(flight.mode(), Mode::kIndoorNavigation);
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 20.0));
  EXPECT_TRUE(flight.status().mission_done);
  // And after the mission.
  flight.director.set_plan(flight.failed(old));
  flight.fly_for(1.0);
  EXPECT_THAT(flight.transitions, ElementsAre("Indoor Navigation -> Hover: mission finished"));
}

TEST(FlightDirectorMission, AnotherMissionInFlightStopsFirst) {
  Hovering flight;
  flight.begin();
  ASSERT_TRUE(flight.get_under_way());
  const Time old = flight.last.goal->identity;
  const std::vector<MissionWaypoint> other{{{0.0, 2.0, 1.2}, {}}};
  flight.begin(2, other);
  EXPECT_TRUE(flight.under_way());
  flight.plan = {};
  ASSERT_TRUE(flight.tick_until([&] { return flight.last.goal.has_value(); }, 5.0));
  EXPECT_EQ(flight.last.setpoint.reference.velocity, Vector3d::Zero()) << "plans begin at rest";
  EXPECT_NE(flight.last.goal->identity, old);
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_LT((flight.vehicle.p_WB - other[0].position).norm(), 1e-6);
}

TEST(FlightDirectorMission, AMissionAskedForWhileBrakingWaitsForRest) {
  Hovering flight;
  flight.begin();
  ASSERT_TRUE(flight.get_under_way());
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  flight.tick();
  ASSERT_TRUE(flight.under_way());
  flight.plan = {};
  flight.begin(2);
  EXPECT_FALSE(flight.last.goal.has_value());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 30.0));
  EXPECT_TRUE(flight.status().mission_done) << flight.status().reason;
}

/// A plan that jumps would be flown as a kick.
TEST(FlightDirectorMission, APlanThatBeginsElsewhereIsNotFlown) {
  for (const Vector3d& offset : {Vector3d(0.5, 0, 0), Vector3d(0, 0, -0.3)}) {
    for (const bool in_flight : {false, true}) {
      Hovering flight;
      const auto shifted = [&](const PlanGoal& goal) {
        FlatReference from;
        from.position = flight.last.setpoint.reference.position + offset;
        const auto way =
            minimum_snap(flight.now + kTick, from, {{goal.waypoint.position, 0.0}}, {3.0});
        return PlanAnswer{goal.identity, *way, false, "", ""};
      };
      if (in_flight) {
        flight.begin();
        ASSERT_TRUE(flight.get_under_way());
        flight.planner = [&](const PlanGoal& g) { flight.director.set_plan(shifted(g)); };
      } else {
        flight.planner = [&](const PlanGoal& g) { flight.director.set_plan(shifted(g)); };
        flight.begin();
      }
      ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
      EXPECT_THAT(flight.status().reason, HasSubstr("off what is flown"));
    }
  }
}

TEST(FlightDirectorMission, APlanThatBeginsAtAnotherSpeedIsNotFlown) {
  Hovering flight;
  flight.planner = [&](const PlanGoal& goal) {
    FlatReference from = flight.last.setpoint.reference;
    from.velocity = Vector3d(0, 0.5, 0);
    const auto way = minimum_snap(flight.now + kTick, from, {{goal.waypoint.position, 0}}, {3.0});
    flight.director.set_plan({goal.identity, *way, false, "", ""});
  };
  flight.begin();
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_THAT(flight.status().reason, HasSubstr("0.00 m and 0.50 m/s off what is flown"));
}

TEST(FlightDirectorMission, AVehicleThatWasCarriedAwayIsPlannedForFromWhereItIs) {
  Hovering flight;
  flight.planner = nullptr;
  flight.begin(1, {kWaypoints[0]});
  flight.vehicle.p_WB.y() += 0.8;
  FlatReference from;
  from.position = flight.vehicle.p_WB;
  const auto way = minimum_snap(flight.now, from, {{kWaypoints[0].position, 0.0}}, {3.0});
  flight.director.set_plan({flight.last.goal->identity, *way, false, "", ""});
  flight.expect_steps = true;
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  EXPECT_TRUE(flight.status().mission_done) << flight.status().reason;
}

TEST(FlightDirectorMission, NonsenseForAPlanIsRefusedWithAReason) {
  const auto end = [](const std::function<Trajectory(const DirectorFlight&, Vector3d)>& make) {
    Hovering flight;
    flight.planner = [&](const PlanGoal& goal) {
      const Vector3d here = flight.last.setpoint.reference.position;
      flight.director.set_plan({goal.identity, make(flight, here), false, "", ""});
    };
    flight.begin();
    EXPECT_TRUE(flight.fly_until(Mode::kHover, 10.0));
    EXPECT_LT((flight.vehicle.p_WB - Vector3d(0, 0, 1.2)).norm(), 1e-3) << "it stays";
    return flight.status().reason;
  };
  const auto with = [](const Vector3d& here, int axis, double c9) {
    TrajectorySegment segment;
    segment.duration_s = 1.0;
    for (int i = 0; i < 3; ++i) segment.coefficients[static_cast<std::size_t>(i)][0] = here[i];
    segment.coefficients[static_cast<std::size_t>(axis)][9] = c9;
    return segment;
  };
  EXPECT_EQ(end([&](const auto& flight, const Vector3d& here) {
              return Trajectory(flight.now, {with(here, kX, kNan)});
            }),
            "no usable plan to waypoint 1");
  EXPECT_THAT(end([&](const auto& flight, const Vector3d& here) {
                return Trajectory(flight.now, {with(here, kX, 50.0)});
              }),
              HasSubstr("too fast"));
  EXPECT_THAT(end([&](const auto& flight, const Vector3d& here) {
                return Trajectory(flight.now, {with(here, kZ, 1e300)});
              }),
              HasSubstr("too fast"));
  EXPECT_THAT(end([&](const auto& flight, const Vector3d& here) {
                return Trajectory(flight.now, {with(here, kYaw, 1e300)});
              }),
              HasSubstr("too fast"));
  EXPECT_THAT(end([&](const auto& flight, const Vector3d& here) {
                return Trajectory(flight.now + std::chrono::hours(1), {with(here, kX, 0.1)});
              }),
              HasSubstr("was to begin in"));
}

TEST(FlightDirectorMission, APlanReplacesThoseThatWereToBeginLater) {
  Hovering flight;
  flight.planner = nullptr;
  flight.begin(1, {kWaypoints[0]});
  const auto plan = [&](double in_s, double duration_s) {
    const auto way = minimum_snap(flight.now + seconds(in_s), flight.last.setpoint.reference,
                                  {{kWaypoints[0].position, 0.0}}, {duration_s});
    flight.director.set_plan({flight.last.goal->identity, *way, false, "", ""});
  };
  plan(1.5, 5.0);
  flight.tick();
  plan(0.1, 3.0);
  flight.fly_for(1.0);
  EXPECT_TRUE(flight.under_way());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 2.3)) << "the later one is not flown";
  EXPECT_TRUE(flight.status().mission_done);
}

/// A brake cannot end any motion within reason: then the vehicle holds where it is.
TEST(FlightDirectorMission, HoverAfterAnAbsurdYawHoldsTheVehicle) {
  Hovering flight;
  flight.planner = nullptr;
  flight.begin(1, {kWaypoints[0]});
  auto segment = flight.leads_to_goal(*flight.last.goal).trajectory.segments().front();
  segment.coefficients[kYaw][1] = 3e5;
  const Trajectory mad(flight.now, {segment});
  flight.director.set_plan({flight.last.goal->identity, mad, false, "", ""});
  flight.expect_steps = true;
  ASSERT_TRUE(flight.get_under_way());
  const Vector3d here = flight.vehicle.p_WB;
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  flight.tick();
  EXPECT_LT((flight.last.setpoint.reference.position - here).norm(), 0.02);
  EXPECT_EQ(flight.speed(), 0.0);
}

TEST(FlightDirectorMission, AWaypointThatIsNotReachedIsNamed) {
  Hovering flight;
  flight.planner = [&, answered = false](PlanGoal goal) mutable {
    if (std::exchange(answered, true)) return;
    goal.waypoint.position.x() -= 0.4;  // a planner that leads beside it
    flight.director.set_plan(flight.leads_to_goal(goal));
  };
  flight.begin();
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 20.0));
  EXPECT_EQ(flight.status().reason, "waypoint 1 was missed by 0.40 m");
}

TEST(FlightDirectorMission, WaypointsThatAreNoPlacesAreRefused) {
  Hovering flight;
  const auto refusal = [&](const std::vector<MissionWaypoint>& waypoints) {
    const auto result = flight.director.fly(9, waypoints, flight.now);
    return result.ok() ? "accepted" : result.error().reason;
  };
  EXPECT_THAT(refusal({}), HasSubstr("it has no waypoints"));
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e30}) {
    EXPECT_THAT(refusal({kWaypoints[0], {{0, bad, 1}, {}}}), HasSubstr("waypoint 2 is not"));
  }
  EXPECT_THAT(refusal({{{0, 0, 1}, kNan}}), HasSubstr("waypoint 1 is not"));
  EXPECT_EQ(flight.mode(), Mode::kHover);
}

TEST(FlightDirectorMission, ALostEstimateEndsItAndLands) {
  Hovering flight;
  flight.begin();
  ASSERT_TRUE(flight.get_under_way());
  flight.estimator = false;
  ASSERT_TRUE(flight.fly_until(Mode::kLand, 0.3));
  EXPECT_THAT(flight.transitions.back(), HasSubstr("estimate lost"));
  EXPECT_FALSE(flight.last.goal.has_value());
  EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 10.0));
}

}  // namespace
}  // namespace swiftlet::test
