// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"
#include "tests/control/loop_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Behaviour = FlightLoop::Behaviour;
using Flight = LoopFlight;
using ::testing::HasSubstr;

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
    const auto output = loop.step(t0 + ms * kMillisecond, at_rest());
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
        output = loop.step(now, {w, attitude(1e-3 * ms).conjugate() * Vector3d(0, 0, kGravity)});
      }
    }
    ASSERT_EQ(output.behaviour, Behaviour::kLevel);
    const Eigen::Quaterniond error = loop.state().q_WB.conjugate() * attitude(0.1);
    EXPECT_LT(log_so3(error).norm(), 1e-9) << phase << " ms";
    EXPECT_EQ(loop.state().w_WB_B, w);
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
  EXPECT_EQ(flight.loop.step(flight.now, at_rest()).rotor_thrusts, Vector4d::Zero());
}

TEST(FlightLoop, StampsOfAnotherClockAreNotFlown) {
  Flight flight;
  flight.stamps_ahead = std::chrono::seconds(1000);
  flight.fly_for(0.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kMotorsOff) << "and do not start the motors";
  flight.vehicle.place({Vector3d(0, 0, 2)});
  flight.stamps_ahead = Duration(0);
  flight.fly_for(0.5);
  ASSERT_EQ(flight.output.behaviour, Behaviour::kTracking);
  flight.stamps_ahead = std::chrono::seconds(1000);
  flight.reference = [](double) { return hover_at(Vector3d(5, 0, 2)); };
  flight.fly_for(0.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  EXPECT_LT(flight.vehicle.p.x(), 0.05);
  EXPECT_THAT(describe(flight.output), HasSubstr("another clock"));
  flight.stamps_ahead = Duration(0);
  flight.reference = [](double) { return hover_at(Vector3d(0, 0, 2)); };
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
  const auto output = flight.loop.step(flight.now, {Vector3d(kNan, 0, 0), flight.specific_force});
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
  flight.reference = [](double) { return hover_at(Vector3d(0, 0, 2)); };
  flight.estimate_offset.x() = kNan;
  flight.fly_for(0.05);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kInertial);
  flight.fly_for(0.25);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
  // And the sonar.
  flight.loop.set_range_down(kNan);
  flight.fly_for(0.1);
  EXPECT_TRUE(flight.output.rotor_thrusts.allFinite());
}

TEST(FlightLoop, OtherParametersDoNotDisturbTheFlight) {
  Flight flight;
  flight.vehicle.wind_force = Vector3d(0.8, 0, 0);
  flight.fly_for(10.0);
  FlightLoop::Params params = agile();
  params.controller.integral_gain *= 3.0;
  params.controller.max_tilt = 0.5;
  const Vector4d before = flight.output.rotor_thrusts;
  flight.loop.set_params(params);
  for (int k = 0; k < 4; ++k) flight.step();
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
  EXPECT_LT((flight.output.rotor_thrusts - before).norm(), 0.02)
      << "the integral asks for the same";
  // They are used.
  params.controller.position_gain *= 0.5;
  flight.loop.set_params(params);
  flight.vehicle.p.y() += 0.1;
  for (int k = 0; k < 8; ++k) flight.step();
  EXPECT_NEAR(flight.output.tracking.wrench.thrust, flight.output.mixer.achieved.thrust, 0.05);
  FlightLoop same = flight.loop;
  const auto with = flight.loop.step(flight.now, at_rest());
  params.controller.position_gain *= 2.0;
  same.set_params(params);
  EXPECT_GT((same.step(flight.now, at_rest()).rotor_thrusts - with.rotor_thrusts).norm(), 0.05);
  // Those that cannot be flown with change nothing.
  for (int which = 0; which < 3; ++which) {
    FlightLoop::Params bad = params;
    if (which == 0) bad.controller.max_tilt = kNan;
    if (which == 1) bad.carry.max_gap = -1.0;
    if (which == 2) bad.abandoned.timeout = 0.0;
    bad.controller.position_gain *= 3.0;
    FlightLoop untouched = flight.loop, tried = flight.loop;
    EXPECT_THROW(tried.set_params(bad), std::invalid_argument);
    EXPECT_EQ(tried.step(flight.now, at_rest()).rotor_thrusts,
              untouched.step(flight.now, at_rest()).rotor_thrusts);
  }
}

TEST(FlightLoop, ADeadCommanderStaysDeadWhenParametersChange) {
  Flight flight;
  flight.fly_for(0.5);
  flight.commander = false;
  flight.fly_for(0.1);
  flight.loop.set_params(agile());
  flight.fly_for(0.01);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  EXPECT_NEAR(flight.output.setpoint_age, 0.11, 0.011);
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
  EXPECT_TRUE(thrown([](P& p) { p.inertial_timeout = 0.01; }));
  EXPECT_TRUE(thrown([](P& p) { p.velocity_timeout = 0.1; }));
  EXPECT_TRUE(thrown([](P& p) { p.landing_speed = -0.4; }));
  EXPECT_TRUE(thrown([](P& p) { p.ground_time = kNan; }));
  EXPECT_TRUE(thrown([](P& p) { p.sonar.ground_range = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.merging.jerk = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.carry.velocity_time_constant = 0.0; }));
  EXPECT_TRUE(thrown([](P& p) { p.abandoned.braking.acceleration = kNan; }));
  EXPECT_TRUE(thrown([](P& p) { p.abandoned.resistance = 0.5; }));
  EXPECT_TRUE(thrown([](P& p) { p.controller.max_tilt = kNan; }));
}

}  // namespace
}  // namespace swiftlet::test
