// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/flight/flight_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

TEST(Psi, IsHalfTheTraceOfSeed000) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Quaterniond q = exp_so3({normal(random), normal(random), normal(random)});
    const Eigen::Quaterniond q_d = exp_so3({normal(random), normal(random), normal(random)});
    const Eigen::Matrix3d R = q.toRotationMatrix(), R_d = q_d.toRotationMatrix();
    EXPECT_NEAR(psi(q, q_d), 0.5 * (Eigen::Matrix3d::Identity() - R_d.transpose() * R).trace(),
                1e-12);
  }
}

/// A second at 100 Hz, x off by `offset` of the truth.
std::vector<FlightMoment> flight(double offset) {
  std::vector<FlightMoment> moments(100);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    moments[i].t = 0.01 * static_cast<double>(i);
    moments[i].estimate.p_WB.x() = i % 2 == 0 ? offset : -offset;
  }
  return moments;
}

TEST(Rmse, IsByAxisAndOverTheTimeAskedFor) {
  auto moments = flight(0.3);
  const auto error = [](const FlightMoment& m) { return m.estimate.p_WB - m.truth.p_WB; };
  EXPECT_LT((rmse(moments, 0.0, 1.0, error) - Vector3d(0.3, 0, 0)).norm(), 1e-12);
  moments[0].estimate.p_WB.x() = 1e6;
  EXPECT_LT((rmse(moments, 0.005, 1.0, error) - Vector3d(0.3, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(rmse(moments, 5.0, 6.0, error), Vector3d(Vector3d::Zero()));
}

TEST(Nees, IsTheNumberOfDegreesWhereErrorsAreAsTheCovarianceSays) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  double pose = 0.0, velocity = 0.0;
  constexpr int kRuns = 20000;
  for (int i = 0; i < kRuns; ++i) {
    FlightMoment m;
    m.truth.q_WB = exp_so3(vector());
    m.truth.v_WB_W = vector();
    m.pose_covariance.diagonal() << 0.01, 0.04, 0.09, 1e-4, 4e-4, 9e-4;
    m.velocity_covariance_B.diagonal() << 0.01, 0.04, 0.16;
    m.estimate = m.truth;
    m.estimate.p_WB -= Vector3d(0.1, 0.2, 0.3).cwiseProduct(vector());
    m.estimate.q_WB = exp_so3(-Vector3d(0.01, 0.02, 0.03).cwiseProduct(vector())) * m.truth.q_WB;
    m.estimate.v_WB_W -= m.estimate.q_WB * Vector3d(0.1, 0.2, 0.4).cwiseProduct(vector());
    pose += pose_nees(m) / kRuns;
    velocity += velocity_nees(m) / kRuns;
  }
  EXPECT_NEAR(pose, 6.0, 0.1);
  EXPECT_NEAR(velocity, 3.0, 0.06);
}

TEST(Recovery, IsTheTimeAfterWhichItStaysNear) {
  std::vector<FlightMoment> moments(1000);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double t = 0.01 * static_cast<double>(i);
    moments[i].t = t;
    // Swings back with 1/s: |0.7 exp(-t)| is 0.05 after 2.64 s, but it crosses zero before.
    moments[i].truth.p_WB.z() = 0.7 * std::exp(-t) * std::cos(3.0 * t);
  }
  const auto position = [](const FlightMoment& m) { return m.truth.p_WB; };
  const double recovered = recovery_s(moments, 0.0, 10.0, Vector3d::Zero(), 0.05, position);
  EXPECT_GT(recovered, 1.8);
  EXPECT_LT(recovered, 2.65);
  EXPECT_EQ(recovery_s(moments, 5.0, 10.0, Vector3d::Zero(), 0.05, position), 0.0);
  EXPECT_TRUE(std::isinf(recovery_s(moments, 0.0, 10.0, Vector3d(5, 0, 0), 0.05, position)));
}

}  // namespace
}  // namespace swiftlet
