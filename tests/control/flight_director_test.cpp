// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_director.hpp"

#include <limits>
#include <random>
#include <stdexcept>

#include "tests/control/director_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FlightDirectorReadiness, NamesWhatIsMissing) {
  FlightDirector director{settled()};
  Time now(std::chrono::seconds(50));
  const auto refusal = [&] {
    const auto result = director.request(Request::arm(), now);
    const FlightDirector::Status status = director.status(now);
    EXPECT_EQ(status.ready, result.ok());
    if (result.ok()) return std::string("armed");
    EXPECT_THAT(result.error().reason, HasSubstr(status.reason));
    return result.error().reason;
  };
  EXPECT_THAT(refusal(), HasSubstr("no odometry was heard"));
  director.set_estimate(now, {}, 0.5, 0.01);
  EXPECT_THAT(refusal(), HasSubstr("position is known to 0.50 m only"));
  director.set_estimate(now, {}, 0.02, 0.3);
  EXPECT_THAT(refusal(), HasSubstr("heading is known to 0.300 rad only, 0.020 are needed"));
  director.set_estimate(now, {}, 0.02, 0.01);
  EXPECT_THAT(refusal(), HasSubstr("no motor commands were heard"));
  director.set_motors_heard(now);
  EXPECT_THAT(refusal(), HasSubstr("nothing was heard on range/down"));
  director.set_range_down(0.5);
  EXPECT_THAT(refusal(), HasSubstr("the ground is 0.50 m below"));
  director.set_range_down(std::numeric_limits<double>::infinity());
  EXPECT_THAT(refusal(), HasSubstr("hears no echo of the ground"));
  director.set_range_down(0.15);
  director.set_battery(0.1);
  EXPECT_THAT(refusal(), HasSubstr("battery at 10 %, 30 % are needed"));
  director.set_battery(0.5);
  now += std::chrono::milliseconds(300);
  EXPECT_THAT(refusal(), HasSubstr("no odometry for 0.30 s"));
  director.set_estimate(now + std::chrono::hours(1), {}, 0.02, 0.01);
  EXPECT_THAT(refusal(), HasSubstr("odometry is stamped 3600.00 s ahead"));
  now += std::chrono::milliseconds(400);
  director.set_estimate(now, {}, 0.02, 0.01);
  EXPECT_THAT(refusal(), HasSubstr("no motor commands"));
  director.set_motors_heard(now);
  EXPECT_EQ(refusal(), "armed");
}

TEST(FlightDirectorReadiness, WaitsForAnEstimateThatHasSettledWithoutAGap) {
  FlightDirector director{FlightDirector::Params{}};
  const double settling = FlightDirector::Params{}.settling_to_arm;
  ASSERT_GT(settling, 5.0);
  Time now(std::chrono::seconds(50));
  const auto wait = [&](double time, bool estimator) {
    for (const Time end = now + from_seconds(time); now < end; now += kTick) {
      if (estimator) director.set_estimate(now, {}, 0.02, 0.01);
      director.set_motors_heard(now);
      director.set_range_down(0.15);
    }
  };
  wait(settling - 1.0, true);
  EXPECT_THAT(director.request(Request::arm(), now).error().reason,
              HasSubstr("the estimate settles for 1.0 s more"));
  wait(0.2, false);  // as when another estimator takes over
  wait(0.9, true);
  EXPECT_TRUE(director.status(now).ready);
  wait(0.3, false);
  wait(settling - 0.1, true);
  EXPECT_THAT(director.status(now).reason, HasSubstr("settles for 0.1 s more"));
  wait(0.08, true);
  EXPECT_THAT(director.status(now).reason, HasSubstr("settles for 0.1 s more")) << "never 0.0";
  wait(0.12, true);
  EXPECT_TRUE(director.request(Request::arm(), now).ok());
  // An armed vehicle waits, too.
  wait(0.3, false);
  wait(0.1, true);
  EXPECT_THAT(director.request(Request::takeoff(1.0), now).error().reason, HasSubstr("settles"));
  wait(settling, true);
  EXPECT_TRUE(director.request(Request::takeoff(1.0), now).ok());
}

TEST(FlightDirectorReadiness, WhatIsNoNumberDoesNotMakeReady) {
  const auto ready = [](const RigidBodyState& state, double position_sigma, double heading_sigma,
                        double range) {
    FlightDirector director{settled()};
    const Time now(std::chrono::seconds(50));
    director.set_estimate(now, state, position_sigma, heading_sigma);
    director.set_range_down(range);
    director.set_motors_heard(now);
    director.set_battery(kNan);  // not measured
    return director.status(now).ready;
  };
  ASSERT_TRUE(ready({}, 0.02, 0.01, 0.15));
  EXPECT_FALSE(ready({}, kNan, 0.01, 0.15));
  EXPECT_FALSE(ready({}, 0.02, kNan, 0.15));
  EXPECT_FALSE(ready({}, 0.02, 0.01, kNan));
  RigidBodyState broken;
  broken.p_WB.y() = kNan;
  EXPECT_FALSE(ready(broken, 0.02, 0.01, 0.15));
  broken = {};
  broken.v_WB_W.z() = kNan;
  EXPECT_FALSE(ready(broken, 0.02, 0.01, 0.15));
  broken = {};
  broken.q_WB.w() = kNan;
  EXPECT_FALSE(ready(broken, 0.02, 0.01, 0.15));
}

TEST(FlightDirectorTakeoff, ClimbsSmoothlyFromWhereTheVehicleStands) {
  DirectorFlight flight;
  flight.vehicle.p_WB = Vector3d(2.0, -1.0, 0.3);
  flight.floor_z = 0.3;
  flight.vehicle.q_WB = from_yaw(0.7);
  flight.fly_for(0.1);
  ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  EXPECT_NEAR(flight.status().height, 0.0, 1e-9) << "above where it was armed";
  // Carried elsewhere between arming and take-off.
  flight.vehicle.p_WB = Vector3d(3.0, -2.0, 0.3);
  flight.fly_for(0.1);
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kMotorsOff);
  ASSERT_TRUE(flight.director.request(Request::takeoff(1.5), flight.now).ok());
  double lowest_speed = 0.0;
  for (int k = 0; k < 2000 && flight.mode() == Mode::kTakeoff; ++k) {
    flight.tick();
    const FlatReference& r = flight.last.setpoint.reference;
    lowest_speed = std::min(lowest_speed, r.velocity.z());
    EXPECT_LT((r.position - Vector3d(3.0, -2.0, r.position.z())).norm(), 1e-9) << "vertical";
    EXPECT_NEAR(r.yaw, 0.7, 1e-9);
    EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kTrack);
  }
  EXPECT_GE(lowest_speed, -1e-12);
  EXPECT_THAT(flight.transitions, ElementsAre(StartsWith("Takeoff -> Hover: 1.50 m reached")));
  EXPECT_NEAR(flight.vehicle.p_WB.z(), 1.8, 1e-9);
  EXPECT_NEAR(flight.status().height, 1.5, 1e-9);
}

TEST(FlightDirectorTakeoff, WhereNobodyDrivesTheMotorsTheReasonSaysSo) {
  DirectorFlight flight;
  flight.can_climb = false;
  flight.expect_steps = true;
  flight.fly_for(0.1);
  ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  ASSERT_TRUE(flight.director.request(Request::takeoff(1.2), flight.now).ok());
  flight.flight_controller = false;
  flight.director.set_guidance_problem("the flight_controller fell silent 1.00 s ago");
  ASSERT_TRUE(flight.fly_until(Mode::kLand, 10.0));
  ASSERT_FALSE(flight.transitions.empty());
  EXPECT_THAT(flight.transitions.front(),
              AllOf(HasSubstr("still on the ground"), HasSubstr("flight_controller fell silent")));
}

TEST(FlightDirectorTakeoff, AVehicleThatDoesNotLiftIsDisarmedSoon) {
  DirectorFlight flight;
  flight.can_climb = false;
  flight.expect_steps = true;  // down to the vehicle, from the end of the climb
  flight.fly_for(0.1);
  ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  ASSERT_TRUE(flight.director.request(Request::takeoff(1.2), flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kLand, 10.0));
  EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 2.0));
  EXPECT_THAT(flight.transitions, ElementsAre(StartsWith("Takeoff -> Land: still on the ground"),
                                              StartsWith("Land -> Grounded: landed")));
  EXPECT_FALSE(flight.status().armed);
}

TEST(FlightDirectorHover, HoldsWhereItIsWhateverTheVehicleDoes) {
  DirectorFlight flight;
  flight.take_off();
  const FlatReference held = flight.last.setpoint.reference;
  for (int k = 0; k < 1000; ++k) {
    flight.vehicle.p_WB += 0.1 * Vector3d::Random();
    flight.tick();
    ASSERT_EQ(flight.last.setpoint.reference.position, held.position);
    ASSERT_EQ(flight.last.setpoint.reference.velocity, Vector3d::Zero());
  }
}

TEST(FlightDirectorCommands, AskedAgainTheyChangeNothing) {
  const auto fly = [](bool again) {
    DirectorFlight flight;
    std::vector<Vector3d> positions;
    flight.answer_once();
    const auto ask = [&](const Request& request) {
      for (int k = 0; k < 30; ++k) {
        if (k == 0 || again) {
          const auto result = flight.director.request(request, flight.now);
          EXPECT_TRUE(result.ok());
          if (k > 0) {
            EXPECT_EQ(*result, Acceptance::kUnchanged) << to_string(request.kind);
          }
        }
        flight.tick();
        positions.push_back(flight.last.setpoint.reference.position);
      }
    };
    flight.fly_for(0.1);
    ask(Request::arm());
    ask(Request::takeoff(1.0));
    flight.fly_until(Mode::kHover, 10.0);
    const std::vector<MissionWaypoint> waypoints{{{1, 0, 1}, {}}, {{1, 1, 1}, {}}};
    for (int k = 0; k < 100; ++k) {
      if (k == 0 || again) {
        const auto result = flight.director.fly(7, waypoints, flight.now);
        EXPECT_TRUE(result.ok());
        if (k > 0) {
          EXPECT_EQ(*result, Acceptance::kUnchanged);
        }
      }
      flight.tick();
      positions.push_back(flight.last.setpoint.reference.position);
    }
    ask(Request::hover());
    ask(Request::land());
    EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 20.0));
    positions.push_back(flight.last.setpoint.reference.position);
    return positions;
  };
  EXPECT_EQ(fly(true), fly(false));
}

TEST(FlightDirectorLand, FromAMovingReferenceBrakesThenSinksStraight) {
  DirectorFlight flight;
  flight.take_off();
  flight.answer_once(4.0);
  ASSERT_TRUE(flight.director.fly(1, {{{4, 2, 1.2}, {}}}, flight.now).ok());
  flight.fly_for(2.0);
  ASSERT_GT(flight.last.setpoint.reference.velocity.norm(), 1.0);
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  flight.fly_for(0.01);
  EXPECT_GT(flight.last.setpoint.reference.velocity.norm(), 0.9) << "no stop at once";
  EXPECT_FALSE(flight.last.goal.has_value());
  ASSERT_TRUE(flight.tick_until(
      [&] { return flight.last.setpoint.reference.velocity.head<2>().norm() == 0.0; }));
  const Vector3d above = flight.last.setpoint.reference.position;
  EXPECT_NEAR(above.z(), 1.2, 1e-6) << "braked before it sinks";
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 20.0));
  EXPECT_LT((flight.vehicle.p_WB - Vector3d(above.x(), above.y(), 0.0)).norm(), 1e-9);
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kMotorsOff);
}

TEST(FlightDirectorLand, MotorsRunUntilTheVehicleStandsOnTheGround) {
  FlightDirector::Params params;
  params.landing.velocity = 0.05;  // long near the ground
  DirectorFlight flight(params);
  flight.take_off(0.5);
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  for (int k = 0; k < 3000 && flight.altitude() > 0.0; ++k) {
    flight.tick();
    ASSERT_EQ(flight.mode(), Mode::kLand) << "in the air at " << flight.altitude() << " m";
  }
  EXPECT_TRUE(flight.fly_until(Mode::kGrounded, 5.0));
}

struct Ground {
  const char* what;
  double height;  // above the take-off point [m]
  double sonar;   // what it says, 0: the truth [m]
};

class FlightDirectorLandOn : public ::testing::TestWithParam<Ground> {};

TEST_P(FlightDirectorLandOn, EndsOnIt) {
  DirectorFlight flight;
  flight.take_off();
  flight.floor_z = GetParam().height;
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  if (GetParam().sonar > 0.0) {
    flight.sonar = false;
    flight.director.set_range_down(GetParam().sonar);
  }
  for (int k = 0; k < 2000 && flight.mode() == Mode::kLand; ++k) {
    const double altitude = flight.altitude();
    flight.tick();
    if (flight.mode() == Mode::kGrounded) {
      EXPECT_EQ(altitude, 0.0) << "motors off in the air";
    }
  }
  EXPECT_EQ(flight.mode(), Mode::kGrounded);
}

INSTANTIATE_TEST_SUITE_P(Grounds, FlightDirectorLandOn,
                         ::testing::Values(Ground{"Pad", 0.0, 0.0}, Ground{"Table", 0.75, 0.0},
                                           Ground{"LowerFloor", -1.0, 0.0},
                                           Ground{"NoEcho", 0.0, 6.45},
                                           Ground{"StuckAtMinimum", 0.0, 0.15}),
                         [](const auto& ground) { return ground.param.what; });

TEST(FlightDirectorLand, HoverIsAnsweredInTheAirAndRefusedOnTheGround) {
  DirectorFlight flight;
  flight.take_off();
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  flight.fly_for(1.5);
  ASSERT_LT(flight.last.setpoint.reference.velocity.z(), -0.2) << "sinks";
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  flight.fly_for(2.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_GT(flight.altitude(), 0.3);
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  ASSERT_TRUE(flight.tick_until([&] { return flight.altitude() <= 0.0; }));
  const auto result = flight.director.request(Request::hover(), flight.now);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().reason, "hover refused: on the ground already");
}

TEST(FlightDirectorEstimate, LostItSinksLevelAndRegainedItLandsFromWhereItIs) {
  DirectorFlight flight;
  flight.take_off(3.0);
  flight.estimator = false;
  ASSERT_TRUE(flight.fly_until(Mode::kLand, 0.3));
  EXPECT_THAT(flight.transitions.back(), HasSubstr("Hover -> Land: estimate lost: no odometry"));
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kLevel);
  flight.vehicle.v_WB_W.x() = 0.6;  // the wind takes it along
  for (int k = 0; k < 200; ++k) {
    flight.tick();
    ASSERT_EQ(flight.last.setpoint.kind, SetpointKind::kLevel);
    ASSERT_EQ(flight.mode(), Mode::kLand);
  }
  const RigidBodyState found = flight.vehicle;
  flight.estimator = true;
  flight.tick();
  ASSERT_EQ(flight.last.setpoint.kind, SetpointKind::kTrack);
  const FlatReference& r = flight.last.setpoint.reference;
  EXPECT_LT((r.position - found.p_WB).norm(), 1e-9) << "not where it was lost";
  EXPECT_LT((r.velocity - found.v_WB_W).norm(), 1e-9);
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 20.0));
  EXPECT_EQ(flight.altitude(), 0.0);
  EXPECT_NEAR(flight.vehicle.p_WB.x(), found.p_WB.x() + 0.2, 0.2) << "braked, and straight down";
}

TEST(FlightDirectorEstimate, RegainedJustBeforeHoverIsAskedForItHoldsTheVehicle) {
  DirectorFlight flight;
  flight.take_off(3.0);
  flight.estimator = false;
  flight.fly_for(2.0);
  flight.estimator = true;
  flight.now += std::chrono::milliseconds(5);
  flight.feed();
  const Vector3d found = flight.vehicle.p_WB;
  ASSERT_LT(found.z(), 2.5);
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  flight.tick();
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kTrack);
  EXPECT_LT((flight.last.setpoint.reference.position - found).norm(), 0.02);
  flight.fly_for(3.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
}

TEST(FlightDirectorEstimate, LostForGoodItStillEndsOnTheGround) {
  DirectorFlight flight;
  flight.take_off(1.5);
  flight.estimator = false;
  ASSERT_TRUE(flight.fly_until(Mode::kGrounded, 10.0));
  EXPECT_EQ(flight.altitude(), 0.0);
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kMotorsOff);
}

TEST(FlightDirectorParams, UnusableOnesThrow) {
  const auto thrown = [](auto change) {
    FlightDirector::Params params;
    change(params);
    try {
      FlightDirector director(params);
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  using P = FlightDirector::Params;
  EXPECT_FALSE(thrown([](P&) {}));
  EXPECT_TRUE(thrown([](P& p) { p.takeoff.velocity = 1e-12; }));
  EXPECT_TRUE(thrown([](P& p) { p.landing.jerk = kNan; }));
  EXPECT_TRUE(thrown([](P& p) { p.braking.acceleration = -1.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.landing_depth = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.landing_resistance = 1.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.plan_timeout = kNan; }));
  EXPECT_TRUE(thrown([](P& p) { p.estimate_timeout = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.settling_to_arm = -1.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.min_battery_percentage = 2.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.modes.min_altitude = kNan; }));
}

/// Broken and sound inputs in random order: the setpoint stays finite, and what it says is never
/// far from where the vehicle is said to be.
TEST(FlightDirectorRobustness, NoInputMakesASetpointThatIsNotFinite) {
  std::mt19937 random(7);
  const double odd[] = {kNan, std::numeric_limits<double>::infinity(), -1e300, 1e300, 1e9, 0.0};
  int flown = 0;
  for (int round = 0; round < 40; ++round) {
    DirectorFlight flight;
    flight.expect_steps = true;
    const auto number = [&](double sound) { return random() % 4 == 0 ? odd[random() % 6] : sound; };
    flight.planner = [&](const PlanGoal& goal) {
      TrajectorySegment segment;
      segment.duration_s = number(1.0);
      for (Polynomial& c : segment.coefficients) c[0] = number(0.0), c[9] = number(0.1);
      const Time start = flight.now + from_seconds(number(0.05) < 1.0 ? 0.05 : -1e6);
      flight.director.set_plan(
          {goal.identity, Trajectory(start, {segment}), random() % 5 == 0, "", ""});
    };
    flight.fly_for(0.1);
    for (int k = 0; k < 800; ++k) {
      RigidBodyState state = flight.vehicle;
      state.p_WB[random() % 3] = number(1.0);
      state.v_WB_W[random() % 3] = number(0.1);
      state.q_WB.coeffs()[random() % 4] = number(0.0);
      if (random() % 8 == 0) flight.director.set_estimate(flight.now, state, number(0.01), 0.01);
      if (random() % 8 == 0) flight.director.set_range_down(number(0.1));
      if (random() % 400 == 0) flight.director.set_battery(number(0.5));
      if (random() % 100 == 0) {
        flight.director.set_sticks({number(0.5), number(0.5), number(0.5), number(0.5), false},
                                   flight.now);
      }
      if (random() % 8 == 0) {
        flight.director.set_obstacles(NearObstacles({{number(1.0), number(1.0)}}), flight.now);
      }
      switch (random() % 40) {
        case 0:
          (void)flight.director.request(Request::arm(), flight.now);
          break;
        case 1:
          (void)flight.director.request(Request::takeoff(number(1.0)), flight.now);
          break;
        case 2:
          (void)flight.director.request(Request::hover(), flight.now);
          break;
        case 3:
          (void)flight.director.fly(random(), {{{number(1), number(1), 1}, number(0.1)}},
                                    flight.now);
          break;
        case 4:
          if (random() % 4 == 0) (void)flight.director.request(Request::land(), flight.now);
          break;
        case 5:
          (void)flight.director.fly_straight(random(), {{{number(1), number(1), 1}, {}}},
                                             flight.now);
          break;
        case 6:
          (void)flight.director.request(random() % 2 == 0 ? Request::assist() : Request::go_back(),
                                        flight.now);
          break;
        default:
          break;
      }
      flight.tick();  // checks that the setpoint is finite
      if (flight.mode() == Mode::kIndoorNavigation) ++flown;
    }
  }
  EXPECT_GT(flown, 200) << "the test must get as far as flying missions";
}

}  // namespace
}  // namespace swiftlet::test
