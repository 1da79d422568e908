// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// How far the vehicle drifts when its estimator dies: with the simulator's vehicle, wind, IMU,
// phone and sonar, and the estimator's filter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "components/sim/quadrotor.hpp"
#include "components/sim/sensors/imu.hpp"
#include "components/sim/sensors/phone_pose.hpp"
#include "components/sim/sensors/sonar.hpp"
#include "components/sim/wind.hpp"
#include "control/flight_loop.hpp"
#include "estimation/ukf/pose_imu_ukf.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using Behaviour = FlightLoop::Behaviour;

constexpr Duration kMillisecond = std::chrono::milliseconds(1);
constexpr Duration kDeath = std::chrono::seconds(12);  // of the estimator
constexpr double kAltitude = 1.25;                     // of the centre of mass [m]

World flat_ground() {
  World world;
  Shape floor;
  floor.model = "floor";
  floor.kind = Shape::Kind::kPlane;
  world.add(floor);
  return world;
}

/// Stands, or flies at 1 m/s, until the estimator dies.
struct Flight {
  explicit Flight(std::uint64_t seed, double speed_)
      : wind({Vector3d(2.0, 0.0, 0.0), Vector3d(0.6, 0.6, 0.2), 2.0}, RandomStream(seed, "wind")),
        imu(ImuSensor::mpu6000(), RandomStream(seed, "imu0")),
        phone(office_phone(), RandomStream(seed, "phone")),
        sonar({}, RandomStream(seed, "sonar")),
        speed(speed_) {
    RigidBodyState start;
    start.p_WB = Vector3d(0, 0, kAltitude);
    vehicle.reset(Time{}, start);
  }
  static PhonePoseSensor::Params office_phone() {
    PhonePoseSensor::Params params;
    params.yaw_stddev = 0.05;
    return params;
  }

  /// The speed comes slowly, so that it is flown steadily at the end.
  FlatReference reference() const {
    FlatReference r;
    const double t = std::max(0.0, to_seconds(now()) - 4.0), ramp = 2.0;
    r.acceleration.x() = t > 0.0 && t < ramp ? speed / ramp : 0.0;
    r.velocity.x() = speed * std::min(1.0, t / ramp);
    r.position =
        Vector3d(t < ramp ? 0.5 * speed / ramp * t * t : speed * (t - 0.5 * ramp), 0.0, kAltitude);
    return r;
  }

  Time now() const { return vehicle.truth().time; }
  const Vector3d& position() const { return vehicle.truth().body.p_WB; }

  void step() {
    wind.step(kMillisecond);
    vehicle.step(kMillisecond, output.rotor_thrusts, wind.velocity(), world);
    if (const RangeReading* range = sonar.update(vehicle.truth(), world)) {
      loop.set_range_down(range->range);
    }
    const PhonePoseReading* pose = phone.update(vehicle.truth());
    const ImuReading* reading = imu.update(vehicle.truth());
    ++milliseconds;
    if (estimator) estimate(*reading, pose);
    if (commander && milliseconds % 10 == 0) {
      loop.set_setpoint({now(), SetpointKind::kTrack, reference()});
    }
    if (milliseconds % 4 == 0) output = loop.step(now(), reading->sample);
  }

  void estimate(const ImuReading& reading, const PhonePoseReading* pose) {
    if (ukf.initialized()) {
      EXPECT_TRUE(ukf.predict(now(), reading.sample).ok());
    }
    if (pose != nullptr) {
      PoseMeasurement measurement{pose->position, pose->attitude, {}};
      measurement.covariance.setZero();
      measurement.covariance.diagonal() << pose->position_stddev.cwiseAbs2(),
          pose->attitude_stddev.cwiseAbs2();
      if (ukf.initialized()) {
        ukf.update(pose->time, measurement);
      } else {
        EXPECT_TRUE(ukf.initialize(pose->time, measurement).ok());
      }
    }
    if (ukf.initialized() && milliseconds % 4 == 2) loop.set_estimate(now(), ukf.state());
  }

  World world = flat_ground();
  Quadrotor vehicle{Quadrotor::Params{}};
  Wind wind;
  ImuSensor imu;
  PhonePoseSensor phone;
  Sonar sonar;
  PoseImuUkf ukf;
  FlightLoop loop{{}, {}};
  FlightLoop::Output output;
  double speed;
  std::int64_t milliseconds = 0;
  bool estimator = true, commander = true;
};

struct Statistics {
  double median, p95, worst;
};

Statistics statistics_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values[values.size() * 95 / 100], values.back()};
}

/// What may go on after the estimator's death.
enum class Commander { kDiesToo, kTracksOn };

struct Case {
  const char* name;
  double speed;  // [m/s]
  Commander commander;
  double goal;  // of the drift until the ground, in 95 % of all seeds [m]
};

class BlindDescent : public ::testing::TestWithParam<Case> {};

TEST_P(BlindDescent, ComesDownNearWhereTheEstimatorDied) {
  constexpr std::uint64_t kSeeds = 200 / kSlowdown;  // of which the sanitizers see enough
  std::vector<double> drifts, durations;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Flight flight(seed, GetParam().speed);
    while (flight.now() < Time(kDeath)) flight.step();
    ASSERT_EQ(flight.output.behaviour, Behaviour::kTracking);
    flight.estimator = false;
    flight.commander = GetParam().commander == Commander::kTracksOn;
    const Vector3d from = flight.position();
    while (!flight.vehicle.truth().on_ground && flight.now() < Time(2 * kDeath)) flight.step();
    ASSERT_TRUE(flight.vehicle.truth().on_ground) << "seed " << seed;
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate) << "seed " << seed;
    drifts.push_back((flight.position() - from).head<2>().norm());
    durations.push_back(to_seconds(flight.now() - Time(kDeath)));
    // With a commander the motors are his.
    if (flight.commander) continue;
    while (flight.output.armed() && flight.now() < Time(2 * kDeath)) flight.step();
    EXPECT_EQ(flight.output.behaviour, Behaviour::kLanded) << "seed " << seed;
    EXPECT_LT((flight.position() - from).head<2>().norm(), drifts.back() + 0.1) << "seed " << seed;
  }
  const Statistics drift = statistics_of(drifts), duration = statistics_of(durations);
  std::printf("drift %.2f m at the median, %.2f m in 95 %%, %.2f m at worst; %.1f to %.1f s\n",
              drift.median, drift.p95, drift.worst,
              *std::min_element(durations.begin(), durations.end()), duration.worst);
  EXPECT_LT(drift.p95, GetParam().goal);
  EXPECT_LT(duration.worst, 4.0);
}

INSTANTIATE_TEST_SUITE_P(Goals, BlindDescent,
                         ::testing::Values(Case{"Hover", 0.0, Commander::kDiesToo, 0.5},
                                           Case{"Cruise", 1.0, Commander::kDiesToo, 0.8},
                                           Case{"CruiseWithACommander", 1.0, Commander::kTracksOn,
                                                0.8}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace swiftlet::test
