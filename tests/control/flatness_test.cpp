// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flatness.hpp"

#include <gtest/gtest.h>

#include "estimation/geometry/so3.hpp"
#include "tests/control/trajectories.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

FlatAttitude along(const FlatReference& r) {
  return flat_attitude(r.acceleration + Vector3d(0, 0, kGravity), r.jerk, r.snap, r.yaw, r.yaw_rate,
                       r.yaw_acceleration);
}

TEST(Flatness, BodyPointsAlongTheForceAndNoseAlongTheHeading) {
  for (double t = 0.0; t < 6.0; t += 0.1) {
    const FlatReference r = lemniscate(t);
    const Matrix3d R = along(r).R_WC;
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    const Vector3d force = r.acceleration + Vector3d(0, 0, kGravity);
    EXPECT_LT((R.col(2) - force.normalized()).norm(), 1e-12);
    // The body's y axis is across the heading, and the nose points ahead.
    EXPECT_NEAR(R.col(1).dot(Vector3d(std::cos(r.yaw), std::sin(r.yaw), 0)), 0.0, 1e-12);
    EXPECT_GT(R.col(0).dot(Vector3d(std::cos(r.yaw), std::sin(r.yaw), 0)), 0.0);
  }
}

TEST(Flatness, RateAndAccelerationAreTheDerivativesOfTheAttitude) {
  constexpr double h = 1e-4;
  for (double t = 0.0; t < 6.0; t += 0.05) {
    const FlatAttitude now = along(lemniscate(t));
    const FlatAttitude before = along(lemniscate(t - h)), after = along(lemniscate(t + h));
    const Eigen::Quaterniond turn(Matrix3d(before.R_WC.transpose() * after.R_WC));
    EXPECT_LT((log_so3(turn) / (2 * h) - now.angular_velocity).norm(), 1e-5) << t;
    const Vector3d acceleration = (after.angular_velocity - before.angular_velocity) / (2 * h);
    EXPECT_LT((acceleration - now.angular_acceleration).norm(), 1e-4) << t;
  }
}

TEST(Flatness, HoverIsLevelAndStill) {
  FlatReference hover;
  hover.yaw = 1.2;
  const RigidBodyState state = flat_state(hover);
  EXPECT_NEAR(log_so3(state.q_WB * from_yaw(1.2).conjugate()).norm(), 0.0, 1e-12);
  EXPECT_EQ(state.w_WB_B, Vector3d(Vector3d::Zero()));
}

}  // namespace
}  // namespace swiftlet::test
