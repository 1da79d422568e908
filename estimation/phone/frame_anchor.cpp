// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/phone/frame_anchor.hpp"

#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// From axes whose y is up to axes whose z is.
const Quaterniond kLevel(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);

}  // namespace

/// T_PB, in axes whose z is up.
FrameAnchor::Pose FrameAnchor::body_in_phone(const Pose& camera) const {
  const Quaterniond q_up = params_.y_is_up ? kLevel : Quaterniond::Identity();
  Pose body;
  body.attitude = (q_up * camera.attitude * params_.camera.attitude.conjugate()).normalized();
  body.position = q_up * camera.position - body.attitude * params_.camera.position;
  return body;
}

void FrameAnchor::fix(const Pose& camera, const Vector3d& p_WB, double yaw) {
  fixed_position_ = p_WB;
  fixed_yaw_ = yaw;
  poses_ = 0;
  sum_of_positions_.setZero();
  sum_of_headings_.setZero();
  is_fixed_ = true;
  refine(camera);
}

void FrameAnchor::refine(const Pose& camera) {
  const Pose body = body_in_phone(camera);
  const double heading = yaw_of(body.attitude);
  ++poses_;
  sum_of_positions_ += body.position;
  sum_of_headings_ += Eigen::Vector2d(std::cos(heading), std::sin(heading));
  const double mean_heading = std::atan2(sum_of_headings_.y(), sum_of_headings_.x());
  T_WP_.attitude = from_yaw(wrap_angle(fixed_yaw_ - mean_heading));
  T_WP_.position = fixed_position_ - T_WP_.attitude * (sum_of_positions_ / poses_);
}

FrameAnchor::Pose FrameAnchor::body_in_map(const Pose& camera) const {
  const Pose body = body_in_phone(camera);
  return {T_WP_.position + T_WP_.attitude * body.position,
          (T_WP_.attitude * body.attitude).normalized()};
}

FrameAnchor::Covariance FrameAnchor::body_covariance(const Pose& camera,
                                                     const Covariance& covariance) const {
  const Quaterniond q_up = params_.y_is_up ? kLevel : Quaterniond::Identity();
  const Eigen::Matrix3d R_WP = (T_WP_.attitude * q_up).toRotationMatrix();
  const Pose body = body_in_map(camera);
  // p_WB = p_WC + lever, and an attitude error d moves it by d x lever.
  const Vector3d lever = -(body.attitude * params_.camera.position);
  Covariance J = Covariance::Zero();
  J.topLeftCorner<3, 3>() = R_WP;
  J.topRightCorner<3, 3>() = -hat(lever) * R_WP;
  J.bottomRightCorner<3, 3>() = R_WP;
  const Covariance result = J * covariance * J.transpose();
  return 0.5 * (result + result.transpose());
}

}  // namespace swiftlet
