// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/phone/frame_anchor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Pose = FrameAnchor::Pose;

Pose compose(const Pose& a, const Pose& b) {
  return {a.position + a.attitude * b.position, a.attitude * b.attitude};
}
double distance(const Pose& a, const Pose& b) {
  return (a.position - b.position).norm() + a.attitude.angularDistance(b.attitude);
}

class FrameAnchorTest : public testing::Test {
 protected:
  Vector3d vector(double scale) {
    std::normal_distribution<double> normal(0.0, scale);
    return {normal(random_), normal(random_), normal(random_)};
  }
  Pose pose() { return {vector(3.0), exp_so3(vector(1.0))}; }
  /// A frame that differs in place and heading alone.
  Pose level_pose() { return {vector(3.0), from_yaw(vector(2.0).x())}; }

  std::mt19937 random_{1};
};

TEST_F(FrameAnchorTest, TheBodyIsWhereItIsWhateverFrameThePhoneHas) {
  for (int run = 0; run < 100; ++run) {
    FrameAnchor::Params params;
    params.camera = pose();
    const Pose T_WP = level_pose();
    const auto camera_at = [&](const Pose& T_WB) {  // T_PC = T_WP^-1 T_WB T_BC
      const Pose T_PW{-(T_WP.attitude.conjugate() * T_WP.position), T_WP.attitude.conjugate()};
      return compose(compose(T_PW, T_WB), params.camera);
    };
    const Pose start{vector(3.0), from_yaw(vector(1.0).x()) * exp_so3({0.1, -0.05, 0.0})};
    params.start_position = start.position;
    params.start_yaw = yaw_of(start.attitude);
    FrameAnchor anchor(params);
    EXPECT_FALSE(anchor.is_fixed());
    anchor.fix(camera_at(start));
    EXPECT_TRUE(anchor.is_fixed());
    EXPECT_LT(distance(anchor.body_in_map(camera_at(start)), start), 1e-9);
    const Pose later = pose();
    EXPECT_LT(distance(anchor.body_in_map(camera_at(later)), later), 1e-9);
  }
}

TEST_F(FrameAnchorTest, TiltIsMeasuredAndNotAnchored) {
  FrameAnchor::Params params;
  params.start_yaw = 0.7;
  FrameAnchor anchor(params);
  const Quaterniond tilt = exp_so3({0.2, -0.1, 0.0});
  anchor.fix({vector(1.0), from_yaw(-1.3) * tilt});
  const Pose body = anchor.body_in_map({Vector3d::Zero(), from_yaw(-1.3) * tilt});
  const Vector3d up = body.attitude.conjugate() * Vector3d::UnitZ();
  EXPECT_LT((up - tilt.conjugate() * Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(yaw_of(body.attitude), 0.7, 1e-12);
}

TEST_F(FrameAnchorTest, MorePosesMakeItMoreExact) {
  FrameAnchor::Params params;
  params.start_position = {1.0, 2.0, 0.1};
  params.start_yaw = 3.0;  // near where angles wrap
  const Pose truth{{4.0, 5.0, 6.0}, from_yaw(-3.0)};
  const auto noisy = [&] {
    return Pose{truth.position + vector(0.05), truth.attitude * from_yaw(vector(0.2).x())};
  };
  FrameAnchor anchor(params);
  anchor.fix(noisy());
  for (int i = 1; i < 1000; ++i) anchor.refine(noisy());
  const Pose body = anchor.body_in_map(truth);
  EXPECT_LT((body.position - params.start_position).norm(), 0.01);  // 0.05 m / sqrt(1000), times 6
  EXPECT_LT(std::abs(wrap_angle(yaw_of(body.attitude) - 3.0)), 0.03);
}

TEST_F(FrameAnchorTest, UpIsUpWhereYIsUp) {
  FrameAnchor::Params params;
  params.y_is_up = true;
  // As ARCore has a camera in landscape that looks ahead: x right, y up, z backwards.
  params.camera.attitude =
      Quaterniond((Eigen::Matrix3d() << 0, 0, -1, -1, 0, 0, 0, 1, 0).finished());
  FrameAnchor anchor(params);
  anchor.fix({Vector3d::Zero(), Quaterniond::Identity()});
  // One metre up, and two ahead, which is along -z.
  const Pose body = anchor.body_in_map({Vector3d(0.0, 1.0, -2.0), Quaterniond::Identity()});
  EXPECT_LT((body.position - Vector3d(2.0, 0.0, 1.0)).norm(), 1e-12);
  EXPECT_LT(body.attitude.angularDistance(Quaterniond::Identity()), 1e-7);
}

TEST_F(FrameAnchorTest, TheCovarianceIsThatOfTheBody) {
  FrameAnchor::Params params;
  params.camera = {{0.3, -0.2, 0.1}, exp_so3({0.4, 0.2, -0.3})};
  params.y_is_up = true;
  params.start_yaw = 1.0;
  FrameAnchor anchor(params);
  const Pose camera = pose();
  anchor.fix(pose());
  FrameAnchor::Covariance covariance = FrameAnchor::Covariance::Zero();
  covariance.diagonal() << 1e-4, 4e-4, 2e-4, 1e-3, 5e-4, 2e-3;
  covariance(0, 4) = covariance(4, 0) = 1e-4;
  const Eigen::Matrix<double, 6, 6> L = covariance.llt().matrixL();

  // The oracle: many cameras with such errors, and where the body then is.
  const Pose truth = anchor.body_in_map(camera);
  FrameAnchor::Covariance sampled = FrameAnchor::Covariance::Zero();
  constexpr int kCount = 50'000;
  std::normal_distribution<double> normal;
  for (int i = 0; i < kCount; ++i) {
    Eigen::Matrix<double, 6, 1> white;
    for (double& number : white) number = normal(random_);
    const Eigen::Matrix<double, 6, 1> error = L * white;
    const Pose body = anchor.body_in_map(
        {camera.position + error.head<3>(), exp_so3(error.tail<3>()) * camera.attitude});
    Eigen::Matrix<double, 6, 1> seen;
    seen << body.position - truth.position, log_so3(body.attitude * truth.attitude.conjugate());
    sampled += seen * seen.transpose() / kCount;
  }
  const FrameAnchor::Covariance computed = anchor.body_covariance(camera, covariance);
  EXPECT_LT((computed - sampled).norm(), 0.03 * computed.norm());
  EXPECT_EQ(computed, computed.transpose());
}

}  // namespace
}  // namespace swiftlet
