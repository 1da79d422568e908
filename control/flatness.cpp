// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flatness.hpp"

#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A vector that moves: value, first and second derivative by time.
struct Moving {
  Vector3d value, rate, acceleration;
};

Moving cross(const Moving& a, const Moving& b) {
  return {
      a.value.cross(b.value), a.rate.cross(b.value) + a.value.cross(b.rate),
      a.acceleration.cross(b.value) + 2.0 * a.rate.cross(b.rate) + a.value.cross(b.acceleration)};
}

Moving normalized(const Moving& a) {
  const double n = a.value.norm();
  const Vector3d u = a.value / n;
  const double n_rate = u.dot(a.rate);
  const Vector3d u_rate = (a.rate - u * n_rate) / n;
  const double n_acceleration = u_rate.dot(a.rate) + u.dot(a.acceleration);
  return {u, u_rate, (a.acceleration - 2.0 * n_rate * u_rate - n_acceleration * u) / n};
}

}  // namespace

FlatAttitude flat_attitude(const Vector3d& force, const Vector3d& force_rate,
                           const Vector3d& force_acceleration, double yaw, double yaw_rate,
                           double yaw_acceleration) {
  const Vector3d ahead(std::cos(yaw), std::sin(yaw), 0.0);
  const Vector3d aside(-std::sin(yaw), std::cos(yaw), 0.0);
  const Moving heading{ahead, yaw_rate * aside,
                       yaw_acceleration * aside - yaw_rate * yaw_rate * ahead};

  const Moving z = normalized({force, force_rate, force_acceleration});
  const Moving y = normalized(cross(z, heading));
  const Moving x = cross(y, z);

  FlatAttitude flat;
  Matrix3d R_rate, R_acceleration;
  flat.R_WC << x.value, y.value, z.value;
  R_rate << x.rate, y.rate, z.rate;
  R_acceleration << x.acceleration, y.acceleration, z.acceleration;
  // R' = R hat(w) and R'' = R (hat(w') + hat(w)^2); vee drops the symmetric hat(w)^2.
  flat.angular_velocity = vee(flat.R_WC.transpose() * R_rate);
  flat.angular_acceleration = vee(flat.R_WC.transpose() * R_acceleration);
  return flat;
}

RigidBodyState flat_state(const FlatReference& reference) {
  const FlatAttitude flat =
      flat_attitude(reference.acceleration + Vector3d(0.0, 0.0, kGravity), reference.jerk,
                    reference.snap, reference.yaw, reference.yaw_rate, reference.yaw_acceleration);
  return {reference.position, Eigen::Quaterniond(flat.R_WC).normalized(), reference.velocity,
          flat.angular_velocity};
}

}  // namespace swiftlet
