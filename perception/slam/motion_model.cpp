// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/motion_model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastTime = 0.02;  // between scans [s]
// By so much a motion that was seen may be wrong, so that a fast one is not taken for too fast.
constexpr double kDistanceError = 0.05, kAngleError = 0.05;  // [m], [rad]

}  // namespace

void MotionModel::forget() {
  velocity_ = Vector3d::Zero();
  const Vector3d any(params_.max_speed, params_.max_speed, params_.max_yaw_rate);
  covariance_ = (0.5 * any).cwiseAbs2().asDiagonal();
}

Matrix3d MotionModel::covariance_after(double seconds) const {
  const Vector3d change(params_.acceleration, params_.acceleration, params_.yaw_acceleration);
  return covariance_ + Matrix3d((seconds * change.cwiseAbs2()).asDiagonal());
}

std::optional<MotionModel::Motion> MotionModel::predict(double seconds) const {
  if (seconds < kLeastTime || seconds >= params_.max_time) return std::nullopt;
  const Vector3d moved = seconds * velocity_;
  return Motion{{moved.head<2>(), wrap_angle(moved.z())},
                seconds * seconds * covariance_after(seconds)};
}

void MotionModel::update(double seconds, const Pose2& relative, const Matrix3d& information) {
  const bool possible = relative.position.norm() <= params_.max_speed * seconds + kDistanceError &&
                        std::abs(relative.yaw) <= params_.max_yaw_rate * seconds + kAngleError;
  if (!possible || seconds >= params_.max_time) return forget();
  if (seconds <= 0.0) return;
  const Vector3d seen = relative.vector() / seconds;
  const Matrix3d known = covariance_after(seconds).inverse();
  const Matrix3d learned = seconds * seconds * information;
  covariance_ = (known + learned).inverse();
  velocity_ = covariance_ * (known * velocity_ + learned * seen);
  // Its axes have turned with it.
  Matrix3d R = Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-relative.yaw).toRotationMatrix();
  velocity_ = R * velocity_;
  covariance_ = R * covariance_ * R.transpose();
}

}  // namespace swiftlet
