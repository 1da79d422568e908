// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_loop.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "control/flatness.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/control/trajectories.hpp"
#include "tests/control/vehicle_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Behaviour = FlightLoop::Behaviour;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Duration kMillisecond = std::chrono::milliseconds(1);

/// The circle needs more tilt than the default.
FlightLoop::Params agile() {
  FlightLoop::Params params;
  params.controller.max_tilt = 1.0;
  return params;
}

/// A vehicle, an estimator and a commander around the loop, as on board: control at 250 Hz,
/// estimates at 250 Hz, setpoints at 100 Hz.
struct Flight {
  FlightLoop loop{agile(), {}};
  Vehicle vehicle;
  Rotors rotors{QuadrotorModel{}};
  Time now{std::chrono::seconds(10)};
  std::int64_t milliseconds = 0;
  bool estimator = true, commander = true;
  SetpointKind kind = SetpointKind::kTrack;
  Duration stamps_ahead{};     // of setpoints
  Duration estimates_ahead{};  // of estimates
  std::function<FlatReference(double)> reference = [](double) {
    FlatReference hover;
    hover.position = Vector3d(0, 0, 2);
    return hover;
  };
  FlightLoop::Output output;

  Flight() { vehicle.p = Vector3d(0, 0, 2); }

  double t() const { return static_cast<double>(milliseconds) * 1e-3; }

  /// One millisecond.
  void step() {
    if (commander && milliseconds % 10 == 0) {
      loop.set_setpoint({now + stamps_ahead, kind, reference(t())});
    }
    if (estimator && milliseconds % 4 == 1) {
      loop.set_estimate(now + estimates_ahead, vehicle.state());
    }
    if (milliseconds % 4 == 0) output = loop.step(now, vehicle.w);
    vehicle.step(rotors.step(output.rotor_thrusts, 1e-3), 1e-3);
    now += kMillisecond;
    ++milliseconds;
  }

  void fly_for(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds * 1e3 + 0.5); ++k) step();
  }
};

TEST(Extrapolate, IsExactForPolynomialsUpToTheFourthDegree) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 50; ++round) {
    // p(t) = sum c_k t^k, differentiated term by term.
    Eigen::Matrix<double, 3, 5> c;
    for (int i = 0; i < c.size(); ++i) c.data()[i] = normal(random);
    const Vector3d turning(normal(random), normal(random), normal(random));
    const auto at = [&](double t) {
      FlatReference r;
      Vector3d* derivatives[] = {&r.position, &r.velocity, &r.acceleration, &r.jerk, &r.snap};
      for (int order = 0; order < 5; ++order) {
        for (int k = order; k < 5; ++k) {
          double factor = std::pow(t, k - order);
          for (int i = 0; i < order; ++i) factor *= k - i;
          *derivatives[order] += factor * c.col(k);
        }
      }
      r.yaw = turning[0] + turning[1] * t + turning[2] * t * t;
      r.yaw_rate = turning[1] + 2 * turning[2] * t;
      r.yaw_acceleration = 2 * turning[2];
      return r;
    };
    const double t0 = normal(random), dt = 0.3 * normal(random);
    const FlatReference is = extrapolate(at(t0), dt), should = at(t0 + dt);
    EXPECT_LT((is.position - should.position).norm(), 1e-10);
    EXPECT_LT((is.velocity - should.velocity).norm(), 1e-10);
    EXPECT_LT((is.acceleration - should.acceleration).norm(), 1e-10);
    EXPECT_LT((is.jerk - should.jerk).norm(), 1e-10);
    EXPECT_LT((is.snap - should.snap).norm(), 1e-10);
    EXPECT_NEAR(is.yaw, should.yaw, 1e-10);
    EXPECT_NEAR(is.yaw_rate, should.yaw_rate, 1e-10);
    EXPECT_NEAR(is.yaw_acceleration, should.yaw_acceleration, 1e-10);
  }
}

TEST(FlightLoop, TracksAFastReferenceBetweenItsSetpoints) {
  Flight flight;
  flight.reference = circle;
  flight.vehicle.place(flat_state(circle(0.0)));
  flight.fly_for(3.0);
  double worst = 0.0;
  for (int k = 0; k < 4000; ++k) {
    flight.step();
    worst = std::max(worst, (flight.vehicle.p - circle(flight.t()).position).norm());
    ASSERT_EQ(flight.output.behaviour, Behaviour::kTracking);
  }
  // At 3 m/s, a setpoint flown without extrapolation is 3 cm old at the end of its period.
  EXPECT_LT(worst, 0.12);
}

TEST(FlightLoop, ASetpointThatIsFlownBetweenPeriodsIsExtrapolated) {
  FlightLoop loop({}, {});
  FlatReference moving;
  moving.velocity = Vector3d(2, 0, 0);
  moving.acceleration = Vector3d(0, 3, 0);
  const Time t0(std::chrono::seconds(1));
  loop.set_setpoint({t0, SetpointKind::kTrack, moving});
  for (int ms = 0; ms <= 28; ms += 4) {
    const double dt = ms * 1e-3;
    RigidBodyState state;
    state.p_WB = Vector3d(2 * dt, 1.5 * dt * dt, 0);
    state.v_WB_W = Vector3d(2, 3 * dt, 0);
    loop.set_estimate(t0 + ms * kMillisecond, state);
    const auto output = loop.step(t0 + ms * kMillisecond, Vector3d::Zero());
    ASSERT_EQ(output.behaviour, Behaviour::kTracking);
    EXPECT_LT(output.tracking.position_error.norm(), 1e-9);
    EXPECT_LT(output.tracking.velocity_error.norm(), 1e-9);
  }
}

TEST(FlightLoop, ASilentCommanderIsFlownNoLongerThanThreePeriods) {
  for (const Duration ahead : {Duration(0), 50 * kMillisecond, 190 * kMillisecond}) {
    Flight flight;
    flight.stamps_ahead = ahead;
    flight.fly_for(1.0);
    ASSERT_EQ(flight.output.behaviour, Behaviour::kTracking);
    flight.commander = false;  // the last setpoint was sent 10 ms ago
    flight.fly_for(0.016);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking) << "one period late is not dead";
    flight.fly_for(0.012);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint)
        << "stamps " << to_seconds(ahead) << " s ahead";
  }
}

TEST(FlightLoop, WithoutSetpointsItKeepsLevelAtTheThrustOfHovering) {
  Flight flight;
  flight.reference = circle;
  flight.vehicle.place(flat_state(circle(0.0)));
  flight.fly_for(1.0);
  ASSERT_GT(flight.vehicle.tilt(), 0.3);
  flight.commander = false;
  flight.fly_for(0.6);
  const double height = flight.vehicle.p.z();
  for (int k = 0; k < 2000; ++k) {
    flight.step();
    ASSERT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
    ASSERT_LT(flight.vehicle.tilt(), 0.05);
  }
  const double weight = QuadrotorModel{}.mass * kGravity;
  EXPECT_NEAR(flight.output.rotor_thrusts.sum(), weight, 0.01 * weight);
  EXPECT_NEAR(flight.vehicle.p.z(), height, 1.0);
  // A commander that comes back is followed again.
  flight.commander = true;
  flight.fly_for(0.02);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
}

TEST(FlightLoop, WithoutEstimatesTheGyroscopeKeepsItUprightWhileItSinks) {
  for (const Duration ahead : {Duration(0), Duration(std::chrono::hours(1))}) {
    Flight flight;
    flight.reference = circle;
    flight.vehicle.place(flat_state(circle(0.0)));
    flight.fly_for(1.0);
    ASSERT_GT(flight.vehicle.tilt(), 0.3) << "the last estimate must not be level";
    if (ahead > Duration(0)) {
      flight.estimates_ahead = ahead;  // a clock that is wrong is as good as none
      flight.fly_for(0.05);
    }
    flight.estimator = false;
    flight.fly_for(0.06);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
    flight.fly_for(0.6);
    for (int k = 0; k < 2000; ++k) {
      flight.step();
      ASSERT_LT(flight.vehicle.tilt(), 0.05);
    }
    EXPECT_LT(flight.vehicle.v.z(), -0.5) << "sinks";
    EXPECT_GT(flight.vehicle.v.z(), -5.0) << "does not fall";
  }
}

/// The attitude flown with is the analytic one, wherever between two steps the estimate came.
TEST(FlightLoop, CarriesTheAttitudeFromTheTimeOfTheEstimate) {
  const Vector3d w(1.5, -2.0, 0.5);
  const auto attitude = [&](double t) { return exp_so3(w * t); };
  for (int phase = 0; phase < 8; ++phase) {  // ms before the step; beyond 4 it is a late one
    FlightLoop loop({}, {});
    const Time t0(std::chrono::seconds(1));
    FlightLoop::Output output;
    for (int ms = 0; ms <= 100; ++ms) {
      const Time now = t0 + ms * kMillisecond;
      if (ms % 4 == 0) {
        RigidBodyState state;
        state.q_WB = attitude(1e-3 * (ms - phase));
        loop.set_estimate(now - phase * kMillisecond, state);
        loop.set_setpoint({now, SetpointKind::kLevel, {}});
        output = loop.step(now, w);
      }
    }
    RigidBodyState truth;
    truth.q_WB = attitude(0.1);
    truth.w_WB_B = w;
    const Se3Controller controller({}, {});
    const Vector4d expected =
        Mixer(QuadrotorModel{}).mix(controller.level(truth, 0.95)).rotor_thrusts;
    ASSERT_EQ(output.behaviour, Behaviour::kLevel);
    EXPECT_LT((output.rotor_thrusts - expected).norm(), 1e-9) << phase << " ms";
  }
}

TEST(FlightLoop, MotorsThatAreOffStayOff) {
  Flight flight;
  flight.commander = false;
  flight.fly_for(0.2);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kMotorsOff) << "never asked for anything";
  flight.commander = true;
  flight.kind = SetpointKind::kMotorsOff;
  flight.fly_for(0.1);
  for (const bool estimator : {true, false}) {
    flight.commander = false;
    flight.estimator = estimator;
    for (int k = 0; k < 500; ++k) {
      flight.step();
      ASSERT_EQ(flight.output.behaviour, Behaviour::kMotorsOff);
      ASSERT_EQ(flight.output.rotor_thrusts, Vector4d::Zero());
    }
  }
}

TEST(FlightLoop, MotorsOffIsObeyedAtOnceWhateverElseTheSetpointSays) {
  Flight flight;
  flight.fly_for(0.5);
  FlightSetpoint off;
  off.time = flight.now;
  off.reference.position.x() = kNan;
  flight.loop.set_setpoint(off);
  EXPECT_EQ(flight.loop.step(flight.now, Vector3d::Zero()).rotor_thrusts, Vector4d::Zero());
}

TEST(FlightLoop, StampsOfAnotherClockAreNotFlown) {
  Flight flight;
  flight.stamps_ahead = std::chrono::seconds(1000);
  flight.fly_for(0.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  flight.stamps_ahead = Duration(0);
  flight.estimates_ahead = -std::chrono::seconds(1);
  flight.fly_for(0.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
  flight.estimates_ahead = Duration(0);
  flight.fly_for(0.02);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
}

TEST(FlightLoop, WhatIsNotFiniteIsAsIfItHadNotCome) {
  Flight flight;
  flight.fly_for(0.5);
  const Vector4d sound = flight.output.rotor_thrusts;
  // The gyroscope: the last good rate is kept.
  const auto output = flight.loop.step(flight.now, Vector3d(kNan, 0, 0));
  EXPECT_LT((output.rotor_thrusts - sound).norm(), 1e-3);
  EXPECT_FALSE(output.tracking.input_refused);
  // The setpoint: stale after its timeout, in spite of the stream of broken ones.
  flight.reference = [](double) {
    FlatReference broken;
    broken.snap.y() = kNan;
    return broken;
  };
  flight.fly_for(0.04);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  // The estimate likewise.
  flight.vehicle.p.x() = kNan;
  for (int k = 0; k < 60; ++k) flight.step();
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
  EXPECT_TRUE(flight.output.rotor_thrusts.allFinite());
}

TEST(FlightLoop, UnusableParametersThrow) {
  const auto thrown = [](auto change) {
    FlightLoop::Params params;
    change(params);
    try {
      FlightLoop loop(params, {});
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  using P = FlightLoop::Params;
  EXPECT_FALSE(thrown([](P&) {}));
  EXPECT_TRUE(thrown([](P& p) { p.setpoint_timeout = kNan; }));
  EXPECT_TRUE(thrown([](P& p) { p.setpoint_timeout = 60.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.estimate_timeout = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.sinking_thrust_to_weight = 1.5; }));
  EXPECT_TRUE(thrown([](P& p) { p.controller.max_tilt = kNan; }));
}

}  // namespace
}  // namespace swiftlet::test
