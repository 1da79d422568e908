// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>

#include "tests/estimation/ukf/imu_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

/// Quantile of chi-square by Wilson and Hilferty, exact to 0.1 % for these many degrees of freedom.
double chi_square(double degrees, double normal_quantile) {
  const double k = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - k + normal_quantile * std::sqrt(k), 3);
}

TEST(PoseImuUkfConsistency, ErrorsOfAnEnsembleAreAsLargeAsTheCovarianceSays) {
  constexpr int kRuns = 100;
  constexpr double kDt = 0.005;
  PoseImuUkf::Params params;
  params.gyro_noise = 5e-3;
  params.bias_random_walk = 2e-2;
  const Matrix6d covariance = pose_covariance(0.03, 0.02);

  std::map<int, double> nees;  // by second
  double nis = 0.0;
  int updates = 0;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(static_cast<unsigned long>(1000 + run));
    Motion motion;
    motion.drift = params.initial_velocity_sigma * noise.vector();
    Vector3d bias = params.initial_accelerometer_bias_sigma * noise.vector();
    PoseImuUkf filter(params);
    ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, covariance, &noise)));
    ASSERT_TRUE(filter.predict(at(0), noisy(motion.imu(0), params, kDt, bias, noise)));
    for (int k = 1; k <= 2000; ++k) {
      const double t = k * kDt;
      bias += params.bias_random_walk * std::sqrt(kDt) * noise.vector();
      ASSERT_TRUE(filter.predict(at(t), noisy(motion.imu(t), params, kDt, bias, noise)));
      if (k % 7 == 0) {  // the 30 Hz of a phone
        nis += filter.update(at(t), measure(motion, t, covariance, &noise)).nis;
        ++updates;
      }
      if (k % 400 == 0) {
        const auto error = error_of(filter, motion, t, bias);
        nees[k / 200] += error.dot(filter.covariance().ldlt().solve(error)) / kRuns;
      }
    }
  }
  // Two-sided 95 % bands.
  const double low = chi_square(12.0 * kRuns, -1.96) / kRuns;
  const double high = chi_square(12.0 * kRuns, 1.96) / kRuns;
  for (const auto& [second, value] : nees) {
    EXPECT_GT(value, low) << "after " << second << " s";
    EXPECT_LT(value, high) << "after " << second << " s";
  }
  EXPECT_GT(nis / updates, chi_square(6.0 * updates, -1.96) / updates);
  EXPECT_LT(nis / updates, chi_square(6.0 * updates, 1.96) / updates);
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
  EXPECT_NEAR(filter.covariance()(0, 0) / (common + tilt), 1.0, 2e-3);
  EXPECT_NEAR(filter.covariance()(2, 2) / common, 1.0, 2e-3);
  EXPECT_NEAR(filter.covariance()(8, 8) / (square(a) + square(params.gyro_noise) * t), 1.0, 1e-6);
}

TEST(PoseImuUkfConsistency, UpdateAddsTheInformationOfTheMeasurement) {
  PoseImuUkf filter;
  Noise noise(3);
  const Motion motion;
  Matrix6d L;
  for (int i = 0; i < 36; ++i) L(i) = 0.02 * noise();
  const Matrix6d R = L * L.transpose() + 1e-4 * Matrix6d::Identity();
  ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, R)));
  for (int k = 0; k <= 100; ++k) ASSERT_TRUE(filter.predict(at(0.005 * k), motion.imu(0.005 * k)));

  // The attitude is measured as predicted, so that axes do not turn with the correction.
  const PoseImuUkf::Covariance P = filter.covariance();
  Eigen::Matrix<double, 6, 12> H = Eigen::Matrix<double, 6, 12>::Zero();
  H.block<3, 3>(0, 0).setIdentity();
  H.block<3, 3>(3, 6).setIdentity();
  PoseMeasurement z{filter.state().p_WB + Vector3d(0.01, 0.02, -0.01), filter.state().q_WB, R};
  Vector6d innovation;
  innovation << 0.01, 0.02, -0.01, 0, 0, 0;
  const PoseImuUkf::Covariance posterior =
      (P.inverse() + H.transpose() * R.inverse() * H).inverse();
  const PoseImuUkf::ErrorVector correction = posterior * H.transpose() * R.inverse() * innovation;
  const RigidBodyState before = filter.state();

  const UpdateReport report = filter.update(at(0.5), z);
  ASSERT_EQ(report.outcome, PoseImuUkf::Outcome::kUsed);
  const Matrix6d S = H * P * H.transpose() + R;
  EXPECT_NEAR(report.nis, innovation.dot(S.inverse() * innovation), 1e-9);
  EXPECT_LT((filter.state().p_WB - before.p_WB - correction.head<3>()).norm(), 1e-9);
  EXPECT_LT((filter.state().v_WB_W - before.v_WB_W - correction.segment<3>(3)).norm(), 1e-9);
  EXPECT_LT(
      (log_so3(filter.state().q_WB * before.q_WB.conjugate()) - correction.segment<3>(6)).norm(),
      1e-9);
  EXPECT_LT((filter.accelerometer_bias() - correction.tail<3>()).norm(), 1e-9);
  // To first order in the correction of the attitude, which the axes turn with.
  EXPECT_LT((filter.covariance() - posterior).norm(), 1e-2 * posterior.norm());
  EXPECT_EQ(filter.pose_covariance(), H * filter.covariance() * H.transpose());
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
