// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>

#include "estimation/geometry/rigid_body.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet::bench {

/// The filter of seed 000 with gyroscope bias, written down as the textbook has it, on fixed-size
/// Eigen: 2 n + 1 points of all 15 errors, no more than that. What PoseImuUkf is compared with.
class PlainUkf {
 public:
  static constexpr int kErrors = 15;
  using Vector = Eigen::Matrix<double, kErrors, 1>;
  using Matrix = Eigen::Matrix<double, kErrors, kErrors>;
  using Measured = Eigen::Matrix<double, 6, 1>;
  using MeasuredCovariance = Eigen::Matrix<double, 6, 6>;

  void predict(const ImuSample& imu, double dt) {
    spread();
    for (State& s : points_) {
      const Eigen::Vector3d a = s.q * (imu.specific_force - s.ba) - Eigen::Vector3d(0, 0, kGravity);
      s.p += s.v * dt + 0.5 * dt * dt * a;
      s.v += a * dt;
      s.q = s.q * exp_so3((imu.angular_velocity - s.bg) * dt);
    }
    State mean = points_[0];
    for (int round = 0; round < 2; ++round) {
      Vector off = Vector::Zero();
      for (std::size_t i = 0; i < points_.size(); ++i) off += weight(i) * minus(points_[i], mean);
      mean = plus(mean, off);
    }
    covariance_ = dt * noise_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector off = minus(points_[i], mean);
      covariance_ += weight(i) * off * off.transpose();
    }
    mean_ = mean;
  }

  void update(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, const MeasuredCovariance& R) {
    spread();
    std::array<Measured, kPoints> seen;
    Measured expected = Measured::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      seen[i] << points_[i].p, log_so3(points_[i].q * mean_.q.conjugate());
      expected += weight(i) * seen[i];
    }
    MeasuredCovariance S = R;
    Eigen::Matrix<double, kErrors, 6> cross = Eigen::Matrix<double, kErrors, 6>::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Measured off = seen[i] - expected;
      S += weight(i) * off * off.transpose();
      cross += weight(i) * minus(points_[i], mean_) * off.transpose();
    }
    const Eigen::Matrix<double, kErrors, 6> K = S.llt().solve(cross.transpose()).transpose();
    Measured innovation;
    innovation << p, log_so3(q * mean_.q.conjugate());
    mean_ = plus(mean_, K * (innovation - expected));
    covariance_ -= K * S * K.transpose();
  }

  double trace() const { return covariance_.trace(); }

 private:
  struct State {
    Eigen::Vector3d p = Eigen::Vector3d::Zero(), v = p, ba = p, bg = p;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  };
  static constexpr std::size_t kPoints = 2 * kErrors + 1;
  static constexpr double kSpread = 3.0;  // n + kappa

  static double weight(std::size_t i) {
    return i == 0 ? (kSpread - kErrors) / kSpread : 0.5 / kSpread;
  }
  static State plus(const State& s, const Vector& d) {
    State r;
    r.p = s.p + d.segment<3>(0);
    r.v = s.v + d.segment<3>(3);
    r.q = exp_so3(d.segment<3>(6)) * s.q;
    r.ba = s.ba + d.segment<3>(9);
    r.bg = s.bg + d.segment<3>(12);
    return r;
  }
  static Vector minus(const State& a, const State& b) {
    Vector d;
    d << a.p - b.p, a.v - b.v, log_so3(a.q * b.q.conjugate()), a.ba - b.ba, a.bg - b.bg;
    return d;
  }
  void spread() {
    const Matrix L = (kSpread * covariance_).llt().matrixL();
    points_[0] = mean_;
    for (int i = 0; i < kErrors; ++i) {
      points_[static_cast<std::size_t>(1 + 2 * i)] = plus(mean_, L.col(i));
      points_[static_cast<std::size_t>(2 + 2 * i)] = plus(mean_, -L.col(i));
    }
  }

  State mean_;
  Matrix covariance_ = 1e-2 * Matrix::Identity();
  Matrix noise_ = 1e-3 * Matrix::Identity();
  std::array<State, kPoints> points_;
};

}  // namespace swiftlet::bench
