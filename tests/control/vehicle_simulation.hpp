// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "control/mixer.hpp"
#include "control/se3_controller.hpp"

namespace swiftlet::test {

/// Equation 1 of seed 000 in ENU/FLU on a rotation matrix, by Runge-Kutta of fourth order: shares
/// nothing with the code under test.
struct Vehicle {
  QuadrotorModel model;
  Eigen::Vector3d p = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d wind_force = Eigen::Vector3d::Zero();  // [N]

  void place(const RigidBodyState& s) {
    p = s.p_WB, v = s.v_WB_W, R = s.q_WB.toRotationMatrix(), w = s.w_WB_B;
  }
  RigidBodyState state() const { return {p, Eigen::Quaterniond(R).normalized(), v, w}; }
  double tilt() const { return std::acos(std::min(1.0, std::max(-1.0, R(2, 2)))); }

  void step(const Wrench& u, double dt) {
    using Eigen::Matrix3d;
    using Eigen::Vector3d;
    struct Rate {
      Vector3d p, v;
      Matrix3d R;
      Vector3d w;
    };
    const Vector3d J = model.inertia;
    const auto rate = [&](const Vector3d& v_, const Matrix3d& R_, const Vector3d& w_) {
      Matrix3d W;
      W << 0, -w_.z(), w_.y(), w_.z(), 0, -w_.x(), -w_.y(), w_.x(), 0;
      const Vector3d spin = u.moment - w_.cross(Vector3d(J.cwiseProduct(w_)));
      return Rate{v_, (R_.col(2) * u.thrust + wind_force) / model.mass - Vector3d(0, 0, 9.80665),
                  R_ * W, spin.cwiseQuotient(J)};
    };
    const Rate a = rate(v, R, w);
    const Rate b = rate(v + dt / 2 * a.v, R + dt / 2 * a.R, w + dt / 2 * a.w);
    const Rate c = rate(v + dt / 2 * b.v, R + dt / 2 * b.R, w + dt / 2 * b.w);
    const Rate d = rate(v + dt * c.v, R + dt * c.R, w + dt * c.w);
    p += dt / 6 * (a.p + 2 * b.p + 2 * c.p + d.p);
    v += dt / 6 * (a.v + 2 * b.v + 2 * c.v + d.v);
    R += dt / 6 * (a.R + 2 * b.R + 2 * c.R + d.R);
    w += dt / 6 * (a.w + 2 * b.w + 2 * c.w + d.w);
    R = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  }
};

/// Rotors that follow their command with a first-order lag.
struct Rotors {
  Eigen::Vector4d thrusts;
  QuadrotorModel model;
  explicit Rotors(const QuadrotorModel& m)
      : thrusts(Eigen::Vector4d::Constant(m.mass * 9.80665 / 4)), model(m) {}
  Wrench step(const Eigen::Vector4d& commanded, double dt) {
    thrusts += (commanded - thrusts) * (1.0 - std::exp(-dt / model.rotor_time_constant));
    const Eigen::Vector4d w = allocation_matrix(model) * thrusts;
    return {w(0), w.tail<3>()};
  }
};

}  // namespace swiftlet::test
