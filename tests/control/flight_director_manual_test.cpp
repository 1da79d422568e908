// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Flying by hand: Manual, Assisted Manual, and how sticks take over.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "director_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A flight with a remote control and, where there are walls, a LIDAR.
struct HandFlight : DirectorFlight {
  explicit HandFlight(const FlightDirector::Params& params = {}) : DirectorFlight(params) {}

  bool remote = true, lidar = true;
  Sticks sticks;
  std::vector<Eigen::Vector2d> walls;

  void step() {
    if (remote) director.set_sticks(sticks, now);
    const auto milliseconds = now.time_since_epoch() / std::chrono::milliseconds(1);
    if (lidar && milliseconds % 100 == 0) director.set_obstacles(NearObstacles(walls), now);
    tick();
  }
  void hold(const Sticks& held, double duration_s) {
    sticks = held;
    for (const Time end = now + seconds(duration_s); now < end;) step();
  }
  void release(double duration_s) { hold({0, 0, 0, 0, sticks.assisted}, duration_s); }

  double clearance() const { return NearObstacles(walls).clearance(vehicle.p_WB.head<2>()); }
};

/// Walls of a room as a LIDAR of one degree sees them from its middle.
std::vector<Eigen::Vector2d> room(double half_width, double half_depth) {
  std::vector<Eigen::Vector2d> points;
  for (int degree = 0; degree < 360; ++degree) {
    const double angle = degree * M_PI / 180.0;
    const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
    points.push_back(beam * std::min(half_width / std::max(std::abs(beam.x()), 1e-9),
                                     half_depth / std::max(std::abs(beam.y()), 1e-9)));
  }
  return points;
}

TEST(FlightDirectorManual, FliesWhereTheSticksPointAndHoldsWhenTheyAreReleased) {
  HandFlight flight;
  flight.take_off();
  flight.release(0.1);
  ASSERT_TRUE(flight.director.request(Request::manual(), flight.now).ok());
  EXPECT_EQ(flight.mode(), Mode::kManual);
  const Eigen::Vector3d before = flight.vehicle.p_WB;
  flight.release(1.0);
  EXPECT_LT((flight.vehicle.p_WB - before).norm(), 1e-9) << "centred sticks hold";
  flight.hold({1.0, 0.0, 0.0, 0.0, false}, 3.0);
  EXPECT_NEAR(flight.vehicle.v_WB_W.x(), 1.0, 0.01);
  EXPECT_GT(flight.vehicle.p_WB.x(), 1.8);
  flight.release(1.5);
  const Eigen::Vector3d stopped = flight.vehicle.p_WB;
  flight.release(5.0);
  EXPECT_LT((flight.vehicle.p_WB - stopped).norm(), 1e-9);
  flight.hold({0.0, 0.0, 1.0, 0.0, false}, 2.0);
  EXPECT_NEAR(flight.vehicle.v_WB_W.z(), 0.5, 0.01);
  flight.hold({0.0, 0.0, 0.0, 1.0, false}, 2.0);
  EXPECT_GT(yaw_of(flight.vehicle.q_WB), 1.0);
  flight.release(1.0);
  EXPECT_EQ(flight.mode(), Mode::kManual);
}

TEST(FlightDirectorManual, TheFloorAndTheCeilingStopTheSticks) {
  FlightDirector::Params params;
  params.modes.max_altitude = 3.0;
  HandFlight flight(params);
  flight.take_off();
  flight.release(0.1);
  ASSERT_TRUE(flight.director.request(Request::manual(), flight.now).ok());
  flight.hold({0.0, 0.0, -1.0, 0.0, false}, 8.0);
  EXPECT_NEAR(flight.altitude(), params.lowest_range + 0.05, 0.05) << "the sonar sits 5 cm below";
  EXPECT_EQ(flight.mode(), Mode::kManual);
  flight.hold({0.0, 0.0, 1.0, 0.0, false}, 15.0);
  EXPECT_NEAR(flight.altitude(), 3.0, 0.03);
}

TEST(FlightDirectorManual, NobodyFliesWithoutARemoteControl) {
  HandFlight flight;
  flight.take_off();
  EXPECT_THAT(flight.director.request(Request::manual(), flight.now).error().reason,
              HasSubstr("no remote control was heard"));
  flight.release(0.1);
  ASSERT_TRUE(flight.director.request(Request::manual(), flight.now).ok());
  flight.hold({1.0, 0.0, 0.0, 0.0, false}, 2.0);
  flight.remote = false;
  flight.step();
  const double x = flight.vehicle.p_WB.x();
  flight.hold(flight.sticks, 0.4);
  EXPECT_EQ(flight.mode(), Mode::kManual);
  EXPECT_LT(flight.vehicle.v_WB_W.x(), 0.9) << "silent sticks count as released after 0.15 s";
  flight.hold(flight.sticks, 3.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_THAT(flight.transitions.back(), HasSubstr("the remote control has been silent for 0.5"));
  EXPECT_LT(flight.vehicle.p_WB.x() - x, 0.75);
  flight.director.set_sticks({kNan, 0, 0, 0, false}, flight.now);
  EXPECT_FALSE(flight.director.request(Request::manual(), flight.now).ok());
}

TEST(FlightDirectorManual, AStickThatIsMovedTakesOverFromEveryModeInTheAir) {
  for (const bool assisted : {false, true}) {
    for (const Mode mode : {Mode::kTakeoff, Mode::kHover, Mode::kLand, Mode::kIndoorNavigation,
                            Mode::kIndoorExploration, Mode::kGpsGuidance}) {
      HandFlight flight;
      flight.answer_once();
      flight.walls = room(20.0, 20.0);
      if (mode == Mode::kTakeoff) {
        flight.fly_for(0.05);
        ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
        ASSERT_TRUE(flight.director.request(Request::takeoff(1.2), flight.now).ok());
        flight.release(0.8);
      } else {
        flight.take_off();
        if (mode == Mode::kLand) {
          ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
        }
        if (mode == Mode::kIndoorNavigation) {
          ASSERT_TRUE(flight.director.fly(1, {{{3, 0, 1.2}, {}}}, flight.now).ok());
        }
        if (mode == Mode::kIndoorExploration) {
          ASSERT_TRUE(flight.director.request(Request::explore(), flight.now).ok());
        }
        if (mode == Mode::kGpsGuidance) {
          ASSERT_TRUE(flight.director.fly_straight(1, {{{3, 0, 2.0}, {}}}, flight.now).ok());
        }
        flight.sticks.assisted = assisted;
        flight.release(0.5);
      }
      ASSERT_EQ(flight.mode(), mode);
      // A touch is no order, and neither is noise.
      flight.hold({0.2, -0.2, 0.0, 0.1, assisted}, 0.2);
      ASSERT_EQ(flight.mode(), mode);
      flight.hold({0.0, 0.9, 0.0, 0.0, assisted}, 0.01);
      EXPECT_EQ(flight.mode(), assisted ? Mode::kAssistedManual : Mode::kManual) << to_string(mode);
      flight.hold({0.0, 0.9, 0.0, 0.0, assisted}, 2.5);
      EXPECT_NEAR(flight.vehicle.v_WB_W.y(), 0.9, 0.02) << to_string(mode);
      EXPECT_THAT(flight.status().reason, HasSubstr("the remote control takes over"));
    }
  }
}

TEST(FlightDirectorManual, OnTheGroundSticksDoNothing) {
  HandFlight flight;
  flight.hold({1.0, 1.0, 1.0, 1.0, false}, 1.0);
  EXPECT_EQ(flight.mode(), Mode::kGrounded);
  EXPECT_FALSE(flight.status().armed);
  EXPECT_EQ(flight.last.setpoint.kind, SetpointKind::kMotorsOff);
}

TEST(FlightDirectorAssisted, AtFullStickFromAHundredAnglesItStopsAtTheDistance) {
  const FlightDirector::Params params;
  const double set = params.vehicle_radius + params.obstacle_distance;
  for (int angle = 0; angle < 100; ++angle) {
    HandFlight flight;
    flight.walls = room(3.0, 2.2);
    flight.sticks.assisted = true;
    flight.take_off();
    flight.release(0.2);
    ASSERT_TRUE(flight.director.request(Request::assist(), flight.now).ok());
    const double direction = angle * 2.0 * M_PI / 100.0;
    flight.sticks = {std::cos(direction), std::sin(direction), 0.0, 0.0, true};
    double least = 1e9;
    for (int k = 0; k < 1200; ++k) {
      flight.step();
      least = std::min(least, flight.clearance());
    }
    EXPECT_NEAR(flight.clearance(), set, 0.05) << angle;
    EXPECT_GT(least, set - 0.05) << angle;
    EXPECT_LT(flight.vehicle.v_WB_W.norm(), 0.02) << angle;
    // It went where the stick pointed, and did not slide along the wall.
    const Eigen::Vector2d went = flight.vehicle.p_WB.head<2>();
    EXPECT_NEAR(std::remainder(std::atan2(went.y(), went.x()) - direction, 2.0 * M_PI), 0.0, 0.02);
    EXPECT_EQ(flight.mode(), Mode::kAssistedManual);
    // Away from the wall it is free.
    flight.hold({-std::cos(direction), -std::sin(direction), 0.0, 0.0, true}, 2.0);
    EXPECT_GT(flight.clearance(), set + 0.5) << angle;
  }
}

TEST(FlightDirectorAssisted, WhoComesTooNearIsNotApproachedAndMayBeLeft) {
  HandFlight flight;
  flight.sticks.assisted = true;
  flight.take_off();
  flight.release(0.2);
  ASSERT_TRUE(flight.director.request(Request::assist(), flight.now).ok());
  flight.walls = {{0.4, 0.0}};  // nearer than is set
  flight.release(0.2);
  flight.hold({1.0, 0.0, 0.0, 0.0, true}, 5.0);
  EXPECT_NEAR(0.4 - flight.vehicle.p_WB.x(), 0.555, 0.02) << "who pushes on goes back";
  flight.walls = {{flight.vehicle.p_WB.x() + 0.54, 0.0}};
  flight.release(0.2);
  flight.hold({0.0, 1.0, 0.0, 0.0, true}, 3.0);
  EXPECT_GT(flight.vehicle.p_WB.y(), 0.5) << "along it he may go";
  flight.hold({-1.0, 0.0, 0.0, 0.0, true}, 2.0);
  EXPECT_LT(flight.vehicle.p_WB.x(), -0.8);
}

TEST(FlightDirectorAssisted, AWallThatAppearsAheadIsBrakedFor) {
  HandFlight flight;
  flight.sticks.assisted = true;
  flight.take_off();
  flight.release(0.2);
  ASSERT_TRUE(flight.director.request(Request::assist(), flight.now).ok());
  flight.hold({1.0, 0.0, 0.0, 0.0, true}, 3.0);
  // As near as a brake needs, and a scan's time.
  const double wall = flight.vehicle.p_WB.x() + 0.555 + 0.70;
  for (double y = -1.0; y <= 1.0; y += 0.05) flight.walls.push_back({wall, y});
  flight.hold({1.0, 0.0, 0.0, 0.0, true}, 4.0);
  EXPECT_GT(wall - flight.vehicle.p_WB.x(), 0.50);
  EXPECT_LT(wall - flight.vehicle.p_WB.x(), 0.61);
}

TEST(FlightDirectorAssisted, WithoutALidarItHovers) {
  HandFlight flight;
  flight.sticks.assisted = true;
  flight.lidar = false;
  flight.take_off();
  flight.release(0.1);
  EXPECT_THAT(flight.director.request(Request::assist(), flight.now).error().reason,
              HasSubstr("nothing was seen around; is the LIDAR running?"));
  // Who takes over into it stops what is flown.
  flight.answer_once();
  ASSERT_TRUE(flight.director.fly(1, {{{3, 0, 1.2}, {}}}, flight.now).ok());
  flight.release(1.0);
  flight.hold({1.0, 0.0, 0.0, 0.0, true}, 3.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_LT(flight.vehicle.v_WB_W.norm(), 1e-6);
  EXPECT_THAT(flight.status().reason, HasSubstr("is the LIDAR running?"));

  flight.lidar = true;
  flight.release(0.3);
  ASSERT_TRUE(flight.director.request(Request::assist(), flight.now).ok());
  flight.hold({1.0, 0.0, 0.0, 0.0, true}, 2.0);
  flight.lidar = false;
  flight.hold({0.2, 0.0, 0.0, 0.0, true}, 2.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_THAT(flight.transitions.back(),
              HasSubstr("Assisted Manual -> Hover: the LIDAR has seen nothing for 0.5"));
}

TEST(FlightDirectorManual, ASuccessorGoesOnWithoutAStep) {
  HandFlight flight;
  flight.take_off();
  flight.release(0.1);
  ASSERT_TRUE(flight.director.request(Request::manual(), flight.now).ok());
  flight.hold({0.7, 0.7, 0.0, 0.3, false}, 1.3);
  FlightDirector successor{settled()};
  successor.restore(flight.director.state());
  std::swap(flight.director, successor);
  flight.hold({0.7, 0.7, 0.0, 0.3, false}, 1.0);  // checks that there is no step
  EXPECT_EQ(flight.mode(), Mode::kManual);
  EXPECT_GT(flight.vehicle.v_WB_W.norm(), 0.9);
}

TEST(FlightDirectorManual, ASuccessorWhoHeardNoSticksStopsAndHovers) {
  HandFlight flight;
  flight.take_off();
  flight.release(0.1);
  ASSERT_TRUE(flight.director.request(Request::manual(), flight.now).ok());
  flight.hold({1.0, 0.0, 0.0, 0.0, false}, 1.5);
  FlightDirector successor{settled()};
  successor.restore(flight.director.state());
  std::swap(flight.director, successor);
  flight.remote = false;
  flight.hold({1.0, 0.0, 0.0, 0.0, false}, 3.0);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_THAT(flight.transitions.back(), HasSubstr("no remote control was heard"));
  EXPECT_EQ(flight.vehicle.v_WB_W.norm(), 0.0);
}

}  // namespace
}  // namespace swiftlet::test
