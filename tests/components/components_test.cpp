// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The real components on real Fast DDS, in lockstep: flight_controller and estimator, and what all
// of them answer to parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spdlog/sinks/ostream_sink.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

#include "tests/components/component_bench.hpp"
#include "tests/control/vehicle_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using namespace std::chrono_literals;
using swiftlet_msgs::msg::MotorCommand;
using ::testing::HasSubstr;
namespace setpoint_kind = swiftlet_msgs::msg::Setpoint_Constants;

// --- flight_controller ---------------------------------------------------------------------

double total(const MotorCommand& motors) {
  return std::accumulate(motors.thrust().begin(), motors.thrust().end(), 0.0);
}

/// What a component logs, in lines.
class LogOf {
 public:
  explicit LogOf(const std::string& component)
      : logger_(logger(component)),
        sink_(std::make_shared<spdlog::sinks::ostream_sink_mt>(text_, true)) {
    sink_->set_pattern("%v");
    logger_->sinks().push_back(sink_);
  }
  ~LogOf() { logger_->sinks().pop_back(); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  Logger logger_;
  std::shared_ptr<spdlog::sinks::ostream_sink_mt> sink_;
};

/// The component flies a vehicle along x at 1 m/s and 1.25 m, until somebody goes silent.
struct FlyingBench : Bench {
  static constexpr double kFloor = 0.12;  // [m]
  LogOf log{"flight_controller"};
  Vehicle vehicle;
  Rotors rotors{QuadrotorModel{}};
  Eigen::Vector4d thrust = Eigen::Vector4d::Zero();
  bool armed = false;
  Time estimator_dies = Time::max(), commander_dies = Time::max();
  Time commander_returns = Time::max();  // and says "motors off"
  bool has_sonar = true;
  std::vector<MotorCommand>& motors;
  Publisher<sensor_msgs::msg::Imu> imu = probe.advertise(topic::imu0);
  Publisher<nav_msgs::msg::Odometry> odometry = probe.advertise(topic::odometry);
  Publisher<sensor_msgs::msg::Range> range = probe.advertise(topic::range_down);
  Publisher<swiftlet_msgs::msg::Setpoint> setpoint = probe.advertise(topic::setpoint);

  FlyingBench() : Bench("flight_controller"), motors(record(topic::motors)) {
    vehicle.p = Vector3d(0, 0, 1.25);
    vehicle.v = Vector3d(1, 0, 0);
    probe.subscribe(topic::motors, [this](const MotorCommand& command) {
      armed = command.armed();
      std::copy_n(command.thrust().begin(), 4, thrust.data());
    });
    probe.every(1ms, [this](Time now) { step(now); });
  }

  void step(Time now) {
    const std::int64_t ms = now.time_since_epoch() / 1ms;
    const Vector3d before = vehicle.v;
    if (ms > 20) vehicle.step(rotors.step(thrust, 1e-3), 1e-3);
    if (ms <= 20) vehicle.p += 1e-3 * vehicle.v;  // until it is asked to fly
    if (vehicle.p.z() < kFloor) {
      vehicle.p.z() = kFloor;
      vehicle.v.setZero();
      vehicle.w.setZero();
    }
    sensor_msgs::msg::Imu sample;
    sample.header(make_header(now, frame::kBody));
    sample.angular_velocity(to_vector3(vehicle.w));
    const Vector3d force = (vehicle.v - before) / 1e-3 + Vector3d(0, 0, kGravity);
    sample.linear_acceleration(to_vector3(vehicle.R.transpose() * force));
    imu.publish(sample);
    if (ms % 4 == 0 && now < estimator_dies) odometry.publish(to_odometry(now, vehicle.state()));
    if (ms % 50 == 0 && has_sonar) publish_range();
    if (ms % 10 == 0) publish_setpoint(now);
  }
  void publish_range() {
    sensor_msgs::msg::Range reading;
    reading.range(static_cast<float>(std::max(0.15, vehicle.p.z() - 0.05)));
    range.publish(reading);
  }
  void publish_setpoint(Time now) {
    if (now >= commander_dies && now < commander_returns) return;
    swiftlet_msgs::msg::Setpoint message;
    message.header(make_header(now, frame::kMap));
    message.kind(now < commander_dies ? setpoint_kind::TRACK : setpoint_kind::MOTORS_OFF);
    message.position(to_point({to_seconds(now), 0, 1.25}));
    message.velocity(to_vector3({1, 0, 0}));
    setpoint.publish(message);
  }

  /// The first moment at which the rotors stand still after having turned; none if they turn.
  std::optional<Time> stopped() const {
    bool flew = false;
    for (const MotorCommand& command : motors) {
      if (flew && !command.armed()) return from_msg(command.stamp());
      flew |= command.armed();
    }
    return std::nullopt;
  }
};

TEST(FlightControllerComponent, ASilentCommanderLeavesABrakeAHoldAndALanding) {
  FlyingBench bench;
  bench.commander_dies = Time(2s);
  double furthest = 0.0, height_at_3_s = 0.0;
  bench.probe.every(10ms, [&](Time now) {
    furthest = std::max(furthest, bench.vehicle.p.x());
    if (now == Time(4900ms)) height_at_3_s = bench.vehicle.p.z();
  });
  bench.run_until(Time(12s));
  EXPECT_LT(furthest - 1.99, 0.4) << "from the last setpoint on";
  EXPECT_NEAR(height_at_3_s, 1.25, 0.03) << "holds for three seconds";
  EXPECT_NEAR(bench.vehicle.p.z(), bench.kFloor, 1e-9);
  ASSERT_TRUE(bench.stopped().has_value());
  EXPECT_GT(*bench.stopped(), Time(7s)) << "1.1 m at 0.4 m/s";
  EXPECT_FALSE(bench.armed);
  EXPECT_THAT(bench.log.text(), HasSubstr("nobody sends setpoints for 0.03 s: braking"));
  EXPECT_THAT(bench.log.text(), HasSubstr("abandoned for 3.0"));
  EXPECT_THAT(bench.log.text(), HasSubstr("landed by itself: motors off"));
}

TEST(FlightControllerComponent, ASilentEstimatorIsBridgedByTheImuAndThenItSinks) {
  FlyingBench bench;
  bench.estimator_dies = Time(2s);
  double off_reference = 0.0, furthest = 0.0;
  bench.probe.every(10ms, [&](Time now) {
    const double x = bench.vehicle.p.x();
    if (now < Time(2200ms)) off_reference = std::max(off_reference, std::abs(x - to_seconds(now)));
    furthest = std::max(furthest, x);
  });
  bench.run_until(Time(8s));
  EXPECT_LT(off_reference, 0.05) << "is not to be noticed for a quarter of a second";
  EXPECT_LT(furthest - 2.25, 0.4) << "then it brakes";
  EXPECT_NEAR(bench.vehicle.p.z(), bench.kFloor, 0.01);
  EXPECT_THAT(bench.log.text(),
              HasSubstr("no odometry for 0.03 s: carrying the state on with the IMU"));
  EXPECT_THAT(bench.log.text(), HasSubstr("braking and sinking by the IMU"));
  EXPECT_TRUE(bench.armed) << "there is a commander who stops the motors";
}

TEST(FlightControllerComponent, WithNeitherItStopsOnTheGroundIfThereIsASonar) {
  for (const bool has_sonar : {true, false}) {
    FlyingBench bench;
    bench.has_sonar = has_sonar;
    bench.estimator_dies = bench.commander_dies = Time(2s);
    bench.run_until(Time(10s));
    EXPECT_EQ(bench.armed, !has_sonar);
    EXPECT_NEAR(bench.vehicle.p.z(), bench.kFloor, 0.01);
    EXPECT_LT(bench.vehicle.p.x(), 2.4);
  }
}

TEST(FlightControllerComponent, ACommanderWhoWasStartedAgainDoesNotStopItInTheAir) {
  FlyingBench bench;
  bench.commander_dies = Time(2s);
  bench.commander_returns = Time(2500ms);
  double height_when_stopped = 1e9;
  bench.probe.every(1ms, [&](Time now) {
    if (now > Time(2s) && !bench.armed) {
      height_when_stopped = std::min(height_when_stopped, bench.vehicle.p.z());
    }
  });
  bench.run_until(Time(12s));
  EXPECT_LT(height_when_stopped, 0.14);
  EXPECT_FALSE(bench.armed);
  EXPECT_THAT(bench.log.text(), HasSubstr("\"motors off\" from a commander that was away"));
}

TEST(FlightControllerComponent, SaysWhenACommanderHasAnotherClock) {
  for (const auto& [offset, what] :
       {std::pair{Duration(-50ms), "setpoint: its stamps are 0.05 s behind the IMU's"},
        std::pair{Duration(300ms), "setpoint: its stamps are 0.30 s ahead of the IMU's"},
        std::pair{Duration(0), ""}}) {
    Bench bench("flight_controller");
    auto& statuses = bench.record(topic::component_status);
    bench.send_odometry({0, 0, 0});
    bench.send_imu();
    bench.every(topic::range_down, 50ms, Time{}, [](Time) { return sensor_msgs::msg::Range(); });
    bench.every(topic::setpoint, 10ms, Time{}, [offset = offset](Time now) {
      swiftlet_msgs::msg::Setpoint setpoint;
      setpoint.header(make_header(now + offset, frame::kMap));
      setpoint.kind(setpoint_kind::MOTORS_OFF);
      return setpoint;
    });
    bench.run_until(Time(2s));
    ASSERT_FALSE(statuses.empty());
    const auto& status = statuses.back();
    EXPECT_EQ(status.blocked(), offset != Duration(0));
    ASSERT_EQ(status.problems().size(), offset == Duration(0) ? 0U : 1U);
    if (status.blocked()) {
      EXPECT_THAT(status.problems().front(), HasSubstr(what));
    }
  }
}

TEST(FlightControllerComponent, MotorsStandStillUntilTheyAreAskedFor) {
  Bench bench("flight_controller");
  auto& heard = bench.record(topic::motors);
  bench.send_odometry({0, 0, 0});
  bench.send_imu();
  bench.every(
      topic::setpoint, 10ms, Time{},
      [](Time now) {
        swiftlet_msgs::msg::Setpoint setpoint;
        setpoint.header(make_header(now, frame::kMap));
        setpoint.kind(setpoint_kind::MOTORS_OFF);
        return setpoint;
      },
      Time(500ms));
  bench.run_until(Time(1s));
  EXPECT_NEAR(static_cast<double>(heard.size()), 250, 3)
      << "heard all the time, so that it can be armed";
  for (const MotorCommand& motors : heard) {
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
                      Mistake{"flight_controller", "inertial_timeout: 0.01", "estimate_timeout"},
                      Mistake{"flight_controller", "velocity_timeout: 0.1", "inertial_timeout"},
                      Mistake{"commander", "takeoff_speed: -1", "takeoff_speed"},
                      Mistake{"commander", "takeof_speed: 1", "takeoff_speed"},
                      Mistake{"planner", "max_speed: fast", "max_speed"}));

}  // namespace
}  // namespace swiftlet::test
