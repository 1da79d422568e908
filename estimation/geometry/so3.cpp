// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geometry/so3.hpp"

#include <cmath>

namespace swiftlet {

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  // sin(x/2)/x by its series where the quotient loses digits.
  const double k = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q(std::cos(0.5 * angle), k * phi.x(), k * phi.y(), k * phi.z());
  q.normalize();
  return q;
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double w = sign * q.w();
  const double s = v.norm();
  if (s < 1e-8) return 2.0 / w * v;
  return 2.0 * std::atan2(s, w) / s * v;
}

Eigen::Matrix3d left_jacobian_so3(const Eigen::Vector3d& phi) {
  const double x2 = phi.squaredNorm();
  const double x = std::sqrt(x2);
  // (1 - cos x)/x^2 and (x - sin x)/x^3 by their series where the quotients lose digits.
  const bool small = x < 0.05;
  const double a =
      small ? 1.0 / 2 - x2 / 24 * (1 - x2 / 30 * (1 - x2 / 56)) : (1 - std::cos(x)) / x2;
  const double b =
      small ? 1.0 / 6 - x2 / 120 * (1 - x2 / 42 * (1 - x2 / 72)) : (x - std::sin(x)) / (x2 * x);
  const Eigen::Matrix3d W = hat(phi);
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

Eigen::Matrix3d left_jacobian_integral_so3(const Eigen::Vector3d& phi) {
  const double x2 = phi.squaredNorm();
  const double x = std::sqrt(x2);
  // (x - sin x)/x^3 and (x^2/2 - 1 + cos x)/x^4, likewise.
  const bool small = x < 0.2;
  const double a =
      small ? 1.0 / 6 - x2 / 120 * (1 - x2 / 42 * (1 - x2 / 72)) : (x - std::sin(x)) / (x2 * x);
  const double b = small ? 1.0 / 24 - x2 / 720 * (1 - x2 / 56 * (1 - x2 / 90))
                         : (0.5 * x2 - 1 + std::cos(x)) / (x2 * x2);
  const Eigen::Matrix3d W = hat(phi);
  return 0.5 * Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                    1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

Eigen::Quaterniond from_yaw(double yaw) {
  return Eigen::Quaterniond(std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw));
}

double wrap_angle(double angle) {
  constexpr double kPi = 3.14159265358979323846;
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

}  // namespace swiftlet
