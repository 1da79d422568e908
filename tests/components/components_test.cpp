// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The real components on real Fast DDS, in lockstep: flight_controller and estimator, and what all
// of them answer to parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using namespace std::chrono_literals;
using swiftlet_msgs::msg::MotorCommand;
using ::testing::HasSubstr;
namespace setpoint_kind = swiftlet_msgs::msg::Setpoint_Constants;

// --- flight_controller ---------------------------------------------------------------------

double spread(const MotorCommand& motors) {
  const auto& thrust = motors.thrust();
  return *std::max_element(thrust.begin(), thrust.end()) -
         *std::min_element(thrust.begin(), thrust.end());
}

double total(const MotorCommand& motors) {
  return std::accumulate(motors.thrust().begin(), motors.thrust().end(), 0.0);
}

/// A level vehicle that is asked to be 1 m further on: it pitches. One that keeps level does not.
struct ControllerBench : Bench {
  std::vector<MotorCommand>& motors;

  ControllerBench() : Bench("flight_controller"), motors(record(topic::motors)) {}
  void send_setpoints(Time until, std::uint8_t kind = setpoint_kind::TRACK) {
    every(
        topic::setpoint, 10ms, Time{},
        [kind](Time now) {
          swiftlet_msgs::msg::Setpoint setpoint;
          setpoint.header(make_header(now, frame::kMap));
          setpoint.kind(kind);
          setpoint.position(to_point({1, 0, 2}));
          return setpoint;
        },
        until);
  }
};

constexpr double kWeight = 0.9 * kGravity;

TEST(FlightControllerComponent, RefusesASilentCommanderWithinThreePeriods) {
  ControllerBench bench;
  bench.send_odometry({0, 0, 2});
  bench.send_imu();
  bench.send_setpoints(Time(1s));  // the last one at 0.99 s
  bench.run_until(Time(2s));
  int tracking = 0, level = 0;
  for (const MotorCommand& motors : bench.motors) {
    const Time time = from_msg(motors.stamp());
    if (time <= Time(10ms)) continue;  // not asked for anything yet
    EXPECT_TRUE(motors.armed());
    if (time <= Time(1020ms)) {
      EXPECT_GT(spread(motors), 0.5) << "must follow its setpoints at " << to_seconds(time);
      ++tracking;
    } else {
      EXPECT_LT(spread(motors), 1e-6) << "flies a stale setpoint at " << to_seconds(time);
      EXPECT_NEAR(total(motors), kWeight, 1e-6);
      ++level;
    }
  }
  EXPECT_NEAR(tracking, 250, 5);
  EXPECT_NEAR(level, 245, 5);
}

TEST(FlightControllerComponent, WithoutAFreshEstimateItSinksLevel) {
  ControllerBench bench;
  bench.send_odometry({0, 0, 2}, Time(1s));
  bench.send_imu();
  bench.send_setpoints(Time::max());
  bench.run_until(Time(2s));
  ASSERT_GT(spread(bench.motors[200]), 0.5);
  const MotorCommand& last = bench.motors.back();
  EXPECT_LT(spread(last), 1e-6);
  EXPECT_NEAR(total(last), 0.95 * kWeight, 1e-6);
}

TEST(FlightControllerComponent, MotorsStandStillUntilTheyAreAskedFor) {
  ControllerBench bench;
  bench.send_odometry({0, 0, 0});
  bench.send_imu();
  bench.send_setpoints(Time(500ms), setpoint_kind::MOTORS_OFF);
  bench.run_until(Time(1s));
  EXPECT_NEAR(static_cast<double>(bench.motors.size()), 250, 3)
      << "heard all the time, so that it can be armed";
  for (const MotorCommand& motors : bench.motors) {
    EXPECT_FALSE(motors.armed());
    EXPECT_EQ(total(motors), 0.0);
  }
}

// --- estimator -----------------------------------------------------------------------------

TEST(EstimatorComponent, StartsOnlyWithAPoseThatCanBeUsed) {
  Bench bench("estimator");
  auto& odometry = bench.record(topic::odometry);
  bench.send_imu();
  const auto pose = std::make_shared<Publisher<geometry_msgs::msg::PoseWithCovarianceStamped>>(
      bench.probe.advertise(topic::phone_pose));
  const auto measured = [](Time now, double x, double qw) {
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header(make_header(now, frame::kMap));
    message.pose().pose(to_pose({x, 2.0, 0.5}, {qw, 0, 0, 0}));
    for (std::size_t i = 0; i < 6; ++i) message.pose().covariance()[7 * i] = 1e-4;
    return message;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  bench.at(Time(500ms), pose, [=](Time now) { return measured(now, kNan, 1.0); });
  bench.at(Time(600ms), pose, [=](Time now) { return measured(now, 1.0, 0.0); });
  bench.at(Time(700ms), pose, [=](Time now) {
    auto message = measured(now, 1.0, 1.0);
    message.pose().covariance()[0] = -1.0;
    return message;
  });
  const Time start(1s);
  bench.at(start, pose, [=](Time now) { return measured(now, 1.0, 1.0); });
  bench.run_until(Time(2s));
  ASSERT_NEAR(static_cast<double>(odometry.size()), 250, 3);
  EXPECT_GE(from_msg(odometry.front().header().stamp()), start);
  EXPECT_LE(from_msg(odometry.front().header().stamp()), start + 10ms);
  const RigidBodyState state = from_msg(odometry.front());
  EXPECT_LT((state.p_WB - Vector3d(1.0, 2.0, 0.5)).norm(), 0.01);
  EXPECT_LT(state.v_WB_W.norm(), 0.1);
}

// --- parameters ----------------------------------------------------------------------------

class ComponentParameters : public ::testing::TestWithParam<const char*> {};

TEST_P(ComponentParameters, UnknownOnesAreRefusedByName) {
  const std::string name = GetParam();
  const Config file = Config::parse(name + ":\n  no_such_parameter: 1.0\n", "test.yaml");
  Bench bench("estimator");
  bench.host.add(name, file.child(name));
  try {
    file.finish();
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("test.yaml:2"));
    EXPECT_THAT(error.what(), HasSubstr("no_such_parameter"));
  }
}

INSTANTIATE_TEST_SUITE_P(All, ComponentParameters,
                         ::testing::Values("commander", "estimator", "flight_controller",
                                           "lidar_mapper", "planner"));

struct Mistake {
  const char* component;
  const char* yaml;
  const char* named;  // what the message must contain
};

class ParameterMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(ParameterMistakes, AreRefusedWithPlaceAndRemedy) {
  const Mistake& mistake = GetParam();
  try {
    const Config file = Config::parse(mistake.yaml, "test.yaml");
    Bench bench("estimator");
    bench.host.add(mistake.component, file);
    file.finish();
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("test.yaml:1"));
    EXPECT_THAT(error.what(), HasSubstr(mistake.named));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ParameterMistakes,
    ::testing::Values(Mistake{"estimator", "gyro_nois: 0.1", "gyro_noise"},
                      Mistake{"estimator", "gyro_noise: .nan", "gyro_noise"},
                      Mistake{"estimator", "odometry_every: 0", "odometry_every"},
                      Mistake{"flight_controller", "max_tilt: 3.0", "max_tilt"},
                      Mistake{"flight_controller", "position_gain: [1, 2]", "position_gain"},
                      Mistake{"commander", "takeoff_speed: -1", "takeoff_speed"},
                      Mistake{"commander", "takeof_speed: 1", "takeoff_speed"},
                      Mistake{"planner", "max_speed: fast", "max_speed"}));

}  // namespace
}  // namespace swiftlet::test
