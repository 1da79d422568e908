// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/inertial_carry.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vector3d kUp(0, 0, kGravity);

Time at(double seconds) {
  return Time(from_seconds(seconds));
}

/// A motion in closed form: position by three sines, attitude by a constant turn.
struct Motion {
  Vector3d amplitude{0.4, 0.3, 0.2}, frequency{1.3, 0.9, 1.7};
  Vector3d turn{0.3, -0.2, 0.5};
  RigidBodyState state(double t) const {
    RigidBodyState s;
    for (int i = 0; i < 3; ++i) {
      s.p_WB(i) = amplitude(i) * std::sin(frequency(i) * t);
      s.v_WB_W(i) = amplitude(i) * frequency(i) * std::cos(frequency(i) * t);
    }
    s.q_WB = exp_so3(turn * t);
    s.w_WB_B = turn;
    return s;
  }
  ImuSample imu(double t) const {
    Vector3d acceleration;
    for (int i = 0; i < 3; ++i) {
      acceleration(i) = -amplitude(i) * frequency(i) * frequency(i) * std::sin(frequency(i) * t);
    }
    return {turn, exp_so3(turn * t).conjugate() * (acceleration + kUp)};
  }
};

TEST(InertialCarry, IsExactForConstantSamplesWithoutTurning) {
  const Vector3d a(0.5, -0.3, 0.2);
  RigidBodyState start;
  start.q_WB = exp_so3({0.1, -0.2, 0.7});
  start.p_WB = Vector3d(1, 2, 3);
  start.v_WB_W = Vector3d(0.4, 0.1, -0.2);
  const ImuSample imu{Vector3d::Zero(), start.q_WB.conjugate() * (a + kUp)};
  InertialCarry carry;
  carry.advance(at(0.0), imu);
  carry.correct(at(0.0), start);
  for (int k = 1; k <= 500; ++k) carry.advance(at(0.004 * k), imu);
  EXPECT_LT((carry.state().p_WB - start.p_WB - 2.0 * start.v_WB_W - 2.0 * a).norm(), 1e-9);
  EXPECT_LT((carry.state().v_WB_W - start.v_WB_W - 2.0 * a).norm(), 1e-9);
  EXPECT_TRUE(carry.motion_known());
}

TEST(InertialCarry, IsOfSecondOrderOtherwise) {
  const Motion motion;
  const auto error = [&](double dt) {
    InertialCarry carry;
    carry.advance(at(0.0), motion.imu(0.0));
    carry.correct(at(0.0), motion.state(0.0));
    const int steps = static_cast<int>(std::lround(1.6 / dt));
    for (int k = 1; k <= steps; ++k) carry.advance(at(dt * k), motion.imu(dt * k));
    return (carry.state().p_WB - motion.state(1.6).p_WB).norm();
  };
  EXPECT_LT(error(0.004), 1e-4);
  EXPECT_NEAR(error(0.008) / error(0.004), 4.0, 0.3);
  EXPECT_NEAR(error(0.016) / error(0.008), 4.0, 0.3);
}

TEST(InertialCarry, OdometryIsTakenAtItsOwnTime) {
  const Motion motion;
  for (const double late : {-0.006, -0.002, 0.0, 0.001, 0.003, 0.02}) {
    InertialCarry carry;
    double worst = 0.0;
    for (int k = 0; k <= 250; ++k) {
      const double t = 0.004 * k;
      if (t >= late) carry.correct(at(t - late), motion.state(t - late));
      carry.advance(at(t), motion.imu(t));
      const RigidBodyState should = motion.state(std::max(t, t - late));  // ahead: waited for
      if (k > 10) worst = std::max(worst, (carry.state().p_WB - should.p_WB).norm());
    }
    EXPECT_LT(worst, 2e-4) << late;
  }
}

/// Odometry at 250 Hz with white errors, an IMU with constant ones.
struct Learning {
  InertialCarry carry;
  Motion motion;
  ImuSample error{{0.004, -0.003, 0.002}, {0.08, -0.05, 0.06}};
  std::mt19937 random{17};
  std::normal_distribution<double> normal;
  double t = 0.0;

  Vector3d noise(double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return sigma * Vector3d(x, y, z);
  }
  void advance() {
    t += 0.004;
    ImuSample imu = motion.imu(t);
    imu.angular_velocity += error.angular_velocity;
    imu.specific_force += error.specific_force;
    carry.advance(at(t), imu);
  }
  void run(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds * 250.0); ++k) {
      RigidBodyState odometry = motion.state(t);
      odometry.v_WB_W += noise(0.02);
      odometry.q_WB = odometry.q_WB * exp_so3(noise(0.003));
      carry.correct(at(t), odometry);
      advance();
    }
  }
};

TEST(InertialCarry, LearnsTheErrorsOfBothSensors) {
  Learning learning;
  learning.run(40.0);
  EXPECT_LT((learning.carry.accelerometer_error() - learning.error.specific_force).norm(), 0.02);
  EXPECT_LT((learning.carry.gyroscope_error() - learning.error.angular_velocity).norm(), 4e-4);
  // The angular velocity is passed on as it was measured.
  EXPECT_EQ(learning.carry.state().w_WB_B, learning.motion.turn + learning.error.angular_velocity);
}

TEST(InertialCarry, TheObserverIsABetterStartThanTheLastOdometry) {
  double with = 0.0, without = 0.0, untaught = 0.0, velocity = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Learning learning;
    learning.random.seed(seed);
    learning.run(20.0);
    const auto error_after_3_s = [](Learning run, bool let_go) {
      if (let_go) run.carry.let_go();
      for (int k = 0; k < 750; ++k) run.advance();
      return (run.carry.state().p_WB - run.motion.state(run.t).p_WB).norm();
    };
    with += error_after_3_s(learning, true) / 10.0;
    InertialCarry observed = learning.carry;
    observed.let_go();
    velocity += (observed.state().v_WB_W - learning.motion.state(learning.t).v_WB_W).norm() / 10.0;
    without += error_after_3_s(learning, false) / 10.0;
    Learning fresh;
    fresh.random.seed(seed);
    fresh.run(0.1);
    untaught += error_after_3_s(fresh, true) / 10.0;
  }
  EXPECT_LT(with, 0.10);
  EXPECT_LT(velocity, 0.010) << "odometry's is wrong by 0.03 m/s";
  EXPECT_GT(without, 1.5 * with);
  EXPECT_GT(untaught, 4.0 * with);
}

TEST(InertialCarry, WhatIsLearntIsBounded) {
  Learning learning;
  learning.error = {{0.1, 0.0, 0.0}, {0.0, 5.0, 0.0}};
  learning.run(20.0);
  EXPECT_LE(learning.carry.accelerometer_error().norm(), 1.0 + 1e-9);
  EXPECT_LE(learning.carry.gyroscope_error().norm(), 0.02 + 1e-9);
}

TEST(InertialCarry, AnotherEstimatorDoesNotTeachIt) {
  Learning learning;
  learning.run(30.0);
  const Vector3d before = learning.carry.accelerometer_error();
  RigidBodyState other = learning.motion.state(learning.t);
  other.p_WB += Vector3d(1, 0, 0);
  other.v_WB_W += Vector3d(2, 0, 0);
  other.q_WB = from_yaw(0.5) * other.q_WB;
  learning.carry.correct(at(learning.t), other);
  learning.advance();
  other = learning.motion.state(learning.t);
  learning.carry.correct(at(learning.t), other);
  EXPECT_EQ(learning.carry.accelerometer_error(), before);
}

TEST(InertialCarry, ABrokenSampleIsReplacedByTheLastGoodOne) {
  const ImuSample broken[] = {{{kNan, 0, 0}, kUp},
                              {Vector3d::Zero(), {0, kNan, 0}},
                              {{0, 1e9, 0}, kUp},
                              {Vector3d::Zero(), {0, 0, 1e300}}};
  for (const ImuSample& bad : broken) {
    InertialCarry carry;
    carry.advance(at(0.0), {Vector3d::Zero(), kUp});
    carry.correct(at(0.0), {Vector3d(0, 0, 1)});
    for (int k = 1; k <= 10; ++k) carry.advance(at(0.004 * k), bad);
    EXPECT_TRUE(carry.motion_known());
    EXPECT_LT((carry.state().p_WB - Vector3d(0, 0, 1)).norm(), 1e-9);
    EXPECT_EQ(carry.state().w_WB_B, Vector3d::Zero());
    for (int k = 11; k <= 20; ++k) carry.advance(at(0.004 * k), bad);
    EXPECT_FALSE(carry.motion_known()) << "for longer than max_gap";
    carry.correct(at(0.08), {Vector3d(0, 0, 2)});
    EXPECT_TRUE(carry.motion_known());
    EXPECT_EQ(carry.state().p_WB.z(), 2.0);
  }
}

TEST(InertialCarry, AGapEndsWhatIsKnownOfTheMotion) {
  InertialCarry carry;
  EXPECT_FALSE(carry.motion_known()) << "no odometry yet";
  carry.advance(at(0.0), {Vector3d::Zero(), kUp});
  carry.correct(at(0.0), {});
  carry.advance(at(0.04), {Vector3d::Zero(), kUp});
  EXPECT_TRUE(carry.motion_known());
  carry.advance(at(0.14), {Vector3d::Zero(), kUp});
  EXPECT_FALSE(carry.motion_known());
}

TEST(InertialCarry, NothingMakesTheStateAnythingButFinite) {
  std::mt19937_64 random(23);
  std::normal_distribution<double> normal;
  const auto value = [&] {
    switch (random() % 8) {
      case 0:
        return kNan;
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return 1e300 * normal(random);
      default:
        return std::pow(10.0, 3.0 * normal(random)) * normal(random);
    }
  };
  const auto vector = [&] {
    const double x = value(), y = value(), z = value();
    return Vector3d(x, y, z);
  };
  InertialCarry carry;
  double t = 0.0;
  for (int k = 0; k < 20000; ++k) {
    t += 0.01 * normal(random);
    if (random() % 3 == 0) {
      RigidBodyState state{vector(), Quaterniond(1, 0, 0, 0), vector(), vector()};
      if (random() % 2 == 0) state.q_WB.coeffs()(0) = value();
      carry.correct(at(t + 0.02 * normal(random)), state);
    }
    if (random() % 50 == 0) carry.let_go();
    carry.advance(at(t), {vector(), vector()});
    const RigidBodyState& s = carry.state();
    ASSERT_TRUE(s.p_WB.allFinite() && s.v_WB_W.allFinite() && s.w_WB_B.allFinite());
    ASSERT_NEAR(s.q_WB.norm(), 1.0, 1e-6);
    ASSERT_TRUE(carry.accelerometer_error().allFinite() && carry.gyroscope_error().allFinite());
  }
}

TEST(InertialCarry, UnusableParametersThrowAndChangeNothing) {
  InertialCarry::Params params;
  params.velocity_time_constant = 0.0;
  EXPECT_THROW(InertialCarry{params}, std::invalid_argument);
  params = {};
  params.max_gap = kNan;
  EXPECT_THROW(InertialCarry{params}, std::invalid_argument);
  Learning learning;
  learning.run(5.0);
  const Vector3d learnt = learning.carry.accelerometer_error();
  EXPECT_THROW(learning.carry.set_params(params), std::invalid_argument);
  learning.carry.set_params({});
  EXPECT_EQ(learning.carry.accelerometer_error(), learnt);
}

}  // namespace
}  // namespace swiftlet::test
