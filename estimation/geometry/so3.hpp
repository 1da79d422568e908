// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace swiftlet {

/// The skew-symmetric matrix with hat(a) b = a x b.
inline Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

/// The inverse of hat: the vector of the skew-symmetric part of A.
inline Eigen::Vector3d vee(const Eigen::Matrix3d& A) {
  return 0.5 * Eigen::Vector3d(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
}

/// Unit quaternion of the rotation vector `phi` [rad]: the exponential map of SO(3), exact at and
/// near zero.
Eigen::Quaterniond exp_so3(const Eigen::Vector3d& phi);

/// Rotation vector [rad] of length at most pi of the unit quaternion `q`: the inverse of exp_so3.
/// q and -q give the same vector.
Eigen::Vector3d log_so3(const Eigen::Quaterniond& q);

/// Integral of exp(s phi) over s from 0 to 1, the left Jacobian of SO(3):
/// exp(phi + d) = exp(left_jacobian_so3(phi) d) exp(phi) to first order in d.
Eigen::Matrix3d left_jacobian_so3(const Eigen::Vector3d& phi);

/// Integral of s left_jacobian_so3(s phi) over s from 0 to 1: what a constant specific force in a
/// body that turns by `phi` adds to its position.
Eigen::Matrix3d left_jacobian_integral_so3(const Eigen::Vector3d& phi);

/// Heading [rad] in (-pi, pi] of the body's x axis, seen from above.
double yaw_of(const Eigen::Quaterniond& q);

/// Rotation about the vertical axis by `yaw` [rad].
Eigen::Quaterniond from_yaw(double yaw);

/// The same angle [rad] in (-pi, pi].
double wrap_angle(double angle);

}  // namespace swiftlet
