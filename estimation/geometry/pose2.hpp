// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace swiftlet {

/// The same angle within [-pi, pi].
inline double wrap_angle(double angle) {
  return std::remainder(angle, 2.0 * M_PI);
}

/// Rigid motion of the plane: T_AB takes the coordinates of a point in frame B to those in A.
struct Pose2 {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of B's origin in A [m]
  double yaw = 0.0;                                    ///< from A's x axis to B's [rad]

  Eigen::Vector2d operator*(const Eigen::Vector2d& p_B) const {
    return position + Eigen::Rotation2Dd(yaw) * p_B;
  }
  /// T_AB T_BC = T_AC
  Pose2 operator*(const Pose2& other) const {
    return {*this * other.position, wrap_angle(yaw + other.yaw)};
  }
  Pose2 inverse() const { return {-(Eigen::Rotation2Dd(-yaw) * position), wrap_angle(-yaw)}; }
  Eigen::Vector3d vector() const { return {position.x(), position.y(), yaw}; }
};

/// Where B was on the way from `a` to `b` after `share` of it, straight and turning the short way.
inline Pose2 between(const Pose2& a, const Pose2& b, double share) {
  return {a.position + share * (b.position - a.position),
          wrap_angle(a.yaw + share * wrap_angle(b.yaw - a.yaw))};
}

}  // namespace swiftlet
