// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geometry/so3.hpp"

#include <cmath>

namespace swiftlet {

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  // sin(x/2)/x by its series where the quotient loses digits.
  const double k =
      angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
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
