// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "estimation/geometry/pose_history.hpp"

namespace swiftlet {

/// Turns poses of a camera C in a frame P of its own, whose place nobody knows, into poses of the
/// body B in the map W: T_WB = T_WP T_PC T_BC^-1. The first pose fixes T_WP; more poses of a body
/// that has not moved make it more exact.
///
/// A phone sees gravity, so its frame and the map differ in place and heading alone: T_WP has four
/// degrees of freedom, and the tilt that the phone measures stays as it is.
class FrameAnchor {
 public:
  using Pose = PoseHistory::Pose;
  using Covariance = Eigen::Matrix<double, 6, 6>;

  struct Params {
    Eigen::Vector3d start_position = Eigen::Vector3d::Zero();  ///< p_WB at the first pose [m]
    double start_yaw = 0.0;                                    ///< of the body, at the same [rad]
    Pose camera;           ///< T_BC: where the camera sits on the body
    bool y_is_up = false;  ///< in P, as ARCore and ARKit have it; else z is, as in the map
  };

  explicit FrameAnchor(const Params& params) : params_(params) {}

  /// The body is at the start of Params when the camera is at `camera`.
  void fix(const Pose& camera) { fix(camera, params_.start_position, params_.start_yaw); }
  /// The same for another place [m] and heading [rad] in the map.
  void fix(const Pose& camera, const Eigen::Vector3d& p_WB, double yaw);
  /// The body has not moved since it was fixed: the mean of the poses so far is where it is.
  void refine(const Pose& camera);
  bool is_fixed() const { return is_fixed_; }

  /// T_WB of T_PC. Only where it is fixed.
  Pose body_in_map(const Pose& camera) const;
  /// Of the same poses: position, then rotation about the axes of the frame. Errors of the
  /// camera's attitude move the body, which is on the end of a lever.
  Covariance body_covariance(const Pose& camera, const Covariance& covariance) const;

 private:
  Pose body_in_phone(const Pose& camera) const;

  Params params_;
  bool is_fixed_ = false;
  Pose T_WP_;
  // Where it was fixed to, and what it was fixed by.
  Eigen::Vector3d fixed_position_ = Eigen::Vector3d::Zero();
  double fixed_yaw_ = 0.0;
  int poses_ = 0;
  Eigen::Vector3d sum_of_positions_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d sum_of_headings_ = Eigen::Vector2d::Zero();
};

}  // namespace swiftlet
