// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>

#include "estimation/consistency/consistency_window.hpp"
#include "tests/estimation/ukf/imu_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

TEST(PoseImuUkfConsistency, ErrorsOfAnEnsembleAreAsLargeAsTheCovarianceSays) {
  constexpr int kRuns = 100;
  constexpr double kDt = 0.005;
  PoseImuUkf::Params params;
  params.gyro_noise = 5e-3;
  params.bias_random_walk = 2e-2;
  params.gyro_bias_random_walk = 2e-3;
  params.initial_gyro_bias_sigma = 0.05;
  params.drift_share = 0.5;
  params.drift_time_constant = 3.0;
  const double position_sigma = 0.03, attitude_sigma = 0.02;
  const double drift_sigma = std::sqrt(params.drift_share) * position_sigma;
  const double kept = std::exp(-kDt / params.drift_time_constant);
  const Matrix6d covariance = pose_covariance(position_sigma, attitude_sigma);
  const Matrix6d white =
      pose_covariance(std::sqrt(1.0 - params.drift_share) * position_sigma, attitude_sigma);

  std::map<int, ConsistencyWindow> nees;  // by second
  ConsistencyWindow nis(6);
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(static_cast<unsigned long>(1000 + run));
    Motion motion;
    motion.drift = params.initial_velocity_sigma * noise.vector();
    Biases biases;
    biases.accelerometer = params.initial_accelerometer_bias_sigma * noise.vector();
    biases.gyroscope = params.initial_gyro_bias_sigma * noise.vector();
    biases.drift = drift_sigma * noise.vector();
    const auto pose = [&](double t) {
      PoseMeasurement z = measure(motion, t, white, &noise);
      z.p_WB += biases.drift;
      z.covariance = covariance;
      return z;
    };
    PoseImuUkf filter(params);
    ASSERT_TRUE(filter.initialize(at(0), pose(0)));
    ASSERT_TRUE(filter.predict(at(0), noisy(motion.imu(0), params, kDt, biases, noise)));
    for (int k = 1; k <= 2000; ++k) {
      const double t = k * kDt;
      biases.accelerometer += params.bias_random_walk * std::sqrt(kDt) * noise.vector();
      biases.gyroscope += params.gyro_bias_random_walk * std::sqrt(kDt) * noise.vector();
      biases.drift =
          kept * biases.drift + std::sqrt(1.0 - kept * kept) * drift_sigma * noise.vector();
      ASSERT_TRUE(filter.predict(at(t), noisy(motion.imu(t), params, kDt, biases, noise)));
      if (k % 7 == 0) {  // the 30 Hz of a phone
        nis.add(filter.update(at(t), pose(t)).nis);
      }
      if (k % 400 == 0) {
        const auto error = error_of(filter, motion, t, biases);
        nees.try_emplace(k / 200, PoseImuUkf::kDim)
            .first->second.add(error.dot(filter.covariance().ldlt().solve(error)));
      }
    }
  }
  for (const auto& [second, window] : nees) {
    EXPECT_GT(window.mean(), window.low()) << "after " << second << " s";
    EXPECT_LT(window.mean(), window.high()) << "after " << second << " s";
  }
  EXPECT_GT(nis.mean(), nis.low());
  EXPECT_LT(nis.mean(), nis.high());
}

TEST(PoseImuUkfConsistency, DeadReckoningInHoverGrowsAsItsClosedForm) {
  PoseImuUkf::Params params;
  PoseImuUkf filter(params);
  const double p = 0.02, a = 0.01, v = params.initial_velocity_sigma,
               b = params.initial_accelerometer_bias_sigma;
  ASSERT_TRUE(filter.initialize(
      at(0), {Vector3d::Zero(), Eigen::Quaterniond::Identity(), pose_covariance(p, a)}));
  const ImuSample hover{Vector3d::Zero(), {0, 0, kGravity}};
  for (int k = 1; k <= 2000; ++k) ASSERT_TRUE(filter.predict(at(k * 1e-3), hover));
  const double t = 2.0, g = kGravity;
  const auto square = [](double x) { return x * x; };
  // White noise integrated n times, and initial errors; tilt makes gravity a horizontal force.
  const double common = square(p) + square(v * t) +
                        square(params.accelerometer_noise) * t * t * t / 3 + square(b * t * t / 2) +
                        square(params.bias_random_walk) * std::pow(t, 5) / 20;
  const double tilt =
      square(g * a * t * t / 2) + square(g * params.gyro_noise) * std::pow(t, 5) / 20;
  const double turn = square(g * params.initial_gyro_bias_sigma * t * t * t / 6) +
                      square(g * params.gyro_bias_random_walk) * std::pow(t, 7) / 252;
  EXPECT_NEAR(filter.covariance()(0, 0) / (common + tilt + turn), 1.0, 2e-3);
  EXPECT_NEAR(filter.covariance()(2, 2) / common, 1.0, 2e-3);
  EXPECT_NEAR(filter.covariance()(8, 8) / (square(a) + square(params.gyro_noise) * t +
                                           square(params.initial_gyro_bias_sigma * t) +
                                           square(params.gyro_bias_random_walk) * t * t * t / 3),
              1.0, 1e-4);
}

TEST(PoseImuUkfConsistency, UpdateAddsTheInformationOfTheMeasurement) {
  PoseImuUkf::Params params;
  params.drift_share = 0.3;
  PoseImuUkf filter(params);
  Noise noise(3);
  const Motion motion;
  Matrix6d L;
  for (int i = 0; i < 36; ++i) L(i) = 0.02 * noise();
  const Matrix6d R = L * L.transpose() + 1e-4 * Matrix6d::Identity();
  ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, R)));
  for (int k = 0; k <= 100; ++k) ASSERT_TRUE(filter.predict(at(0.005 * k), motion.imu(0.005 * k)));

  // The attitude is measured as predicted, so that axes do not turn with the correction.
  const PoseImuUkf::Covariance P = filter.covariance();
  Eigen::Matrix<double, 6, PoseImuUkf::kDim> H = Eigen::Matrix<double, 6, PoseImuUkf::kDim>::Zero();
  H.block<3, 3>(0, 0).setIdentity();
  H.block<3, 3>(0, 15).setIdentity();
  H.block<3, 3>(3, 6).setIdentity();
  PoseMeasurement z{filter.state().p_WB + filter.drift() + Vector3d(0.01, 0.02, -0.01),
                    filter.state().q_WB, R};
  Vector6d innovation;
  innovation << 0.01, 0.02, -0.01, 0, 0, 0;
  Matrix6d white = R;
  white.topLeftCorner<3, 3>() *= 1.0 - params.drift_share;
  const PoseImuUkf::Covariance posterior =
      (P.inverse() + H.transpose() * white.inverse() * H).inverse();
  const PoseImuUkf::ErrorVector correction =
      posterior * H.transpose() * white.inverse() * innovation;
  const RigidBodyState before = filter.state();
  const Vector3d drift = filter.drift();

  const UpdateReport report = filter.update(at(0.5), z);
  ASSERT_EQ(report.outcome, PoseImuUkf::Outcome::kUsed);
  const Matrix6d S = H * P * H.transpose() + white;
  EXPECT_NEAR(report.nis, innovation.dot(S.inverse() * innovation), 1e-9);
  EXPECT_LT((filter.state().p_WB - before.p_WB - correction.head<3>()).norm(), 1e-9);
  EXPECT_LT((filter.state().v_WB_W - before.v_WB_W - correction.segment<3>(3)).norm(), 1e-9);
  EXPECT_LT(
      (log_so3(filter.state().q_WB * before.q_WB.conjugate()) - correction.segment<3>(6)).norm(),
      1e-9);
  EXPECT_LT((filter.accelerometer_bias() - correction.segment<3>(9)).norm(), 1e-9);
  EXPECT_LT((filter.gyro_bias() - correction.segment<3>(12)).norm(), 1e-9);
  EXPECT_LT((filter.drift() - drift - correction.tail<3>()).norm(), 1e-9);
  // To first order in the correction of the attitude, which the axes turn with.
  EXPECT_LT((filter.covariance() - posterior).norm(), 1e-2 * posterior.norm());
}

TEST(PoseImuUkfConsistency, ALargeCorrectionTurnsTheAxesThatErrorsAreCountedIn) {
  PoseImuUkf filter;
  const Matrix6d R = pose_covariance(0.1, 0.5);
  ASSERT_TRUE(filter.initialize(at(0), {Vector3d::Zero(), Eigen::Quaterniond::Identity(), R}));
  Matrix6d sharp = pose_covariance(0.1, 0.5);
  sharp(4, 4) = 0.01;  // so that the covariance has directions to turn
  const PoseImuUkf::Covariance P = filter.covariance();
  const Vector3d turn(0.9, 0.2, -0.4);
  ASSERT_EQ(filter.update(at(0), {Vector3d::Zero(), exp_so3(turn), sharp}).outcome,
            PoseImuUkf::Outcome::kUsed);

  const Eigen::Matrix3d P_attitude = P.block<3, 3>(6, 6);
  const Eigen::Matrix3d R_attitude = sharp.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d posterior = (P_attitude.inverse() + R_attitude.inverse()).inverse();
  const Vector3d correction = posterior * R_attitude.inverse() * turn;
  Eigen::Matrix3d J;  // of the error counted from the corrected attitude, by differences
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = 1e-5 * Vector3d::Unit(i);
    const Eigen::Quaterniond back = exp_so3(correction).conjugate();
    J.col(i) =
        (log_so3(exp_so3(correction + d) * back) - log_so3(exp_so3(correction - d) * back)) / 2e-5;
  }
  const Eigen::Matrix3d turned = J * posterior * J.transpose();
  EXPECT_LT((filter.covariance().block<3, 3>(6, 6) - turned).norm(), 1e-6);
  EXPECT_GT((posterior - turned).norm(), 1e-3);
}

}  // namespace
}  // namespace swiftlet::test
