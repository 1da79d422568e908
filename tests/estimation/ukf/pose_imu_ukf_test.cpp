// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/ukf/pose_imu_ukf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/estimation/ukf/imu_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDt = 0.005;

PoseMeasurement sure_pose(const Vector3d& p_WB, const Quaterniond& q_WB) {
  return {p_WB, q_WB, pose_covariance(1e-6, 1e-6)};
}

/// A filter that trusts its input, so that the mean is not bent by a spread of attitudes.
PoseImuUkf sure_filter() {
  PoseImuUkf::Params params;
  params.gyro_noise = params.accelerometer_noise = params.bias_random_walk =
      params.gyro_bias_random_walk = params.initial_gyro_bias_sigma = 1e-9;
  return PoseImuUkf(params);
}

TEST(PoseImuUkf, PredictsTheCycloidOfABodyThatTurnsAndPushesForward) {
  // From rest, with yaw rate w and forward acceleration a in the body, the world sees a cycloid.
  const double w = 1.5, a = 2.0;
  PoseImuUkf filter = sure_filter();
  ASSERT_TRUE(filter.initialize(at(0), sure_pose({1, 2, 3}, Quaterniond::Identity())));
  const ImuSample imu{{0, 0, w}, {a, 0, kGravity}};
  // Few, unequal steps: the integration is exact, not merely fine.
  double t = 0.0;
  for (int k = 0; k < 60; ++k) {
    t += k % 2 == 0 ? 0.09 : 0.01;
    ASSERT_TRUE(filter.predict(at(t), imu));
  }
  const RigidBodyState state = filter.state();
  const Vector3d p =
      Vector3d(1, 2, 3) + a / (w * w) * Vector3d(1 - std::cos(w * t), w * t - std::sin(w * t), 0);
  const Vector3d v = a / w * Vector3d(std::sin(w * t), 1 - std::cos(w * t), 0);
  EXPECT_LT((state.p_WB - p).norm(), 1e-8);
  EXPECT_LT((state.v_WB_W - v).norm(), 1e-8);
  EXPECT_LT(log_so3(state.q_WB * from_yaw(w * t).conjugate()).norm(), 1e-9);
  EXPECT_EQ(state.w_WB_B, Vector3d(0, 0, w));
}

TEST(PoseImuUkf, PredictsAnyMotionToSecondOrderInTheSampleTime) {
  const Motion motion;
  const auto error_with = [&motion](double dt) {
    PoseImuUkf filter = sure_filter();
    EXPECT_TRUE(filter.initialize(at(0), sure_pose(motion.position(0), motion.attitude(0))));
    for (int k = 0; k * dt <= 2.0 + 1e-9; ++k)
      EXPECT_TRUE(filter.predict(at(k * dt), motion.imu(k * dt)));
    return (filter.state().p_WB - motion.position(2.0)).norm();
  };
  const double coarse = error_with(0.04), fine = error_with(0.01);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_NEAR(coarse / fine, 16.0, 3.0);
}

TEST(PoseImuUkf, WithoutNoiseItFindsTruthAndBiases) {
  Motion motion;
  motion.drift = {0.4, -0.3, 0.2};  // the filter starts at rest
  const Biases biases{{0.2, -0.15, 0.1}, {0.02, 0.01, -0.03}, Vector3d::Zero()};
  PoseImuUkf filter;
  const Matrix6d covariance = pose_covariance(1e-3, 1e-3);
  ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, covariance)));
  for (int k = 0; k <= 4000; ++k) {
    const double t = k * kDt;
    ImuSample imu = motion.imu(t);
    imu.specific_force += biases.accelerometer;
    imu.angular_velocity += biases.gyroscope;
    ASSERT_TRUE(filter.predict(at(t), imu));
    if (k % 7 == 0) {
      ASSERT_EQ(filter.update(at(t), measure(motion, t, covariance)).outcome,
                PoseImuUkf::Outcome::kUsed);
    }
  }
  const auto error = error_of(filter, motion, 20.0, biases);
  EXPECT_LT(error.head<3>().norm(), 1e-3);
  EXPECT_LT(error.segment<3>(3).norm(), 2e-3);
  EXPECT_LT(error.segment<3>(6).norm(), 1e-3);
  EXPECT_LT(error.segment<3>(9).norm(), 4e-3);
  EXPECT_LT(error.segment<3>(12).norm(), 1e-3);
  EXPECT_LT((filter.state().w_WB_B - motion.angular_velocity(20.0)).norm(), 1e-3);
  EXPECT_EQ(filter.covariance_repairs(), 0u);
}

TEST(PoseImuUkf, EstimatesBiasAndVelocityUnderNoise) {
  const Motion motion;
  const Biases biases{{0.2, -0.15, 0.1}, {0.02, 0.01, -0.03}, Vector3d::Zero()};
  Noise noise(7);
  PoseImuUkf::Params params;
  PoseImuUkf filter(params);
  const Matrix6d covariance = pose_covariance(0.02, 0.01);
  ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, covariance, &noise)));
  double squared_velocity_error = 0.0;
  int samples = 0;
  for (int k = 0; k <= 6000; ++k) {
    const double t = k * kDt;
    ASSERT_TRUE(filter.predict(at(t), noisy(motion.imu(t), params, kDt, biases, noise)));
    if (k % 7 == 0) filter.update(at(t), measure(motion, t, covariance, &noise));
    if (t > 10.0) {
      squared_velocity_error += error_of(filter, motion, t, biases).segment<3>(3).squaredNorm() / 3;
      ++samples;
    }
  }
  EXPECT_LT((filter.accelerometer_bias() - biases.accelerometer).norm(), 0.05);
  // Seed 000, Table 3: 0.0533 to 0.0788 m/s.
  EXPECT_LT(std::sqrt(squared_velocity_error / samples), 0.0533);
}

TEST(PoseImuUkf, DoesNotCareWhereNorthAndTheOriginAre) {
  const Motion motion;
  const Quaterniond turn = from_yaw(2.2);
  const Vector3d shift(40, -25, 7);
  PoseImuUkf here, there;
  Noise noise(11);
  const Matrix6d covariance = pose_covariance(0.02, 0.01);
  const auto moved = [&](const PoseMeasurement& z) {
    return PoseMeasurement{turn * z.p_WB + shift, turn * z.q_WB, z.covariance};
  };
  const PoseMeasurement first = measure(motion, 0, covariance, &noise);
  ASSERT_TRUE(here.initialize(at(0), first));
  ASSERT_TRUE(there.initialize(at(0), moved(first)));
  for (int k = 0; k <= 1000; ++k) {
    const double t = k * kDt;
    const ImuSample imu = noisy(motion.imu(t), {}, kDt, {{0.1, 0, 0}}, noise);
    ASSERT_TRUE(here.predict(at(t), imu));
    ASSERT_TRUE(there.predict(at(t), imu));
    if (k % 7 != 0) continue;
    const PoseMeasurement z = measure(motion, t, covariance, &noise);
    EXPECT_NEAR(here.update(at(t), z).nis, there.update(at(t), moved(z)).nis, 1e-3);
  }
  EXPECT_LT((turn * here.state().p_WB + shift - there.state().p_WB).norm(), 1e-5);
  EXPECT_LT((turn * here.state().v_WB_W - there.state().v_WB_W).norm(), 1e-5);
  EXPECT_LT(log_so3(turn * here.state().q_WB * there.state().q_WB.conjugate()).norm(), 1e-5);
  EXPECT_LT((here.accelerometer_bias() - there.accelerometer_bias()).norm(), 1e-5);
}

TEST(PoseImuUkf, AQuaternionAndItsNegativeAreTheSameMeasurement) {
  const Motion motion;
  PoseImuUkf one, other;
  const Matrix6d covariance = pose_covariance(0.02, 0.01);
  ASSERT_TRUE(one.initialize(at(0), measure(motion, 0, covariance)));
  other = one;
  PoseMeasurement z = measure(motion, 0.01, covariance);
  one.update(at(0), z);
  z.q_WB.coeffs() *= -1.0;
  other.update(at(0), z);
  EXPECT_EQ(one.state().q_WB.coeffs(), other.state().q_WB.coeffs());
}

TEST(PoseImuUkf, CopiesContinueBitForBit) {
  const Motion motion;
  Noise noise(5);
  const Matrix6d covariance = pose_covariance(0.02, 0.01);
  PoseImuUkf original;
  ASSERT_TRUE(original.initialize(at(0), measure(motion, 0, covariance, &noise)));
  for (int k = 0; k <= 50; ++k) ASSERT_TRUE(original.predict(at(k * kDt), motion.imu(k * kDt)));
  PoseImuUkf copy = original;
  for (PoseImuUkf* filter : {&original, &copy}) {
    Noise same(6);
    for (int k = 51; k <= 500; ++k) {
      ASSERT_TRUE(filter->predict(at(k * kDt), motion.imu(k * kDt)));
      if (k % 7 == 0) filter->update(at(k * kDt), measure(motion, k * kDt, covariance, &same));
    }
  }
  EXPECT_EQ(original.state().p_WB, copy.state().p_WB);
  EXPECT_EQ(original.state().q_WB.coeffs(), copy.state().q_WB.coeffs());
  EXPECT_EQ(original.covariance(), copy.covariance());
}

TEST(PoseImuUkf, AMeasurementAheadOfTheImuMovesTheStateToItsTime) {
  const Motion motion;
  PoseImuUkf filter;
  const Matrix6d covariance = pose_covariance(0.02, 0.01);
  ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, covariance)));
  ASSERT_TRUE(filter.predict(at(0), motion.imu(0)));
  EXPECT_EQ(filter.update(at(0.03), measure(motion, 0.03, covariance)).outcome,
            PoseImuUkf::Outcome::kUsed);
  EXPECT_EQ(filter.time(), at(0.03));
  EXPECT_EQ(filter.last_measurement_time(), at(0.03));
}

}  // namespace
}  // namespace swiftlet::test
