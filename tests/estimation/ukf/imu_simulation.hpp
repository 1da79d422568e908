// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"
#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet::test {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

inline Time at(double seconds) {
  return Time(from_seconds(seconds));
}

/// White noise from one seeded generator.
struct Noise {
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  explicit Noise(unsigned long seed) : random(seed) {}
  double operator()() { return normal(random); }
  Eigen::Vector3d vector() {
    const double x = normal(random), y = normal(random), z = normal(random);
    return {x, y, z};
  }
};

/// A smooth motion in closed form: swaying in all axes, with a constant drift.
struct Motion {
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();

  Eigen::Vector3d position(double t) const {
    return drift * t + Eigen::Vector3d(0.8 * (1 - std::cos(1.1 * t)), 0.6 * (1 - std::cos(1.7 * t)),
                                       1.0 + 0.3 * (1 - std::cos(0.9 * t)));
  }
  Eigen::Vector3d velocity(double t) const {
    return drift + Eigen::Vector3d(0.88 * std::sin(1.1 * t), 1.02 * std::sin(1.7 * t),
                                   0.27 * std::sin(0.9 * t));
  }
  Eigen::Vector3d acceleration(double t) const {
    return {0.968 * std::cos(1.1 * t), 1.734 * std::cos(1.7 * t), 0.243 * std::cos(0.9 * t)};
  }
  Eigen::Quaterniond attitude(double t) const {
    return from_yaw(0.5 * std::sin(0.6 * t)) * exp_so3({0.0, 0.15 * std::sin(1.3 * t), 0.0}) *
           exp_so3({0.2 * std::sin(0.8 * t), 0.0, 0.0});
  }
  /// Angular velocity by differences, far below any noise of a gyroscope.
  Eigen::Vector3d angular_velocity(double t) const {
    constexpr double h = 1e-4;
    return log_so3(attitude(t - h).conjugate() * attitude(t + h)) / (2 * h);
  }
  ImuSample imu(double t) const {
    const Eigen::Vector3d up(0.0, 0.0, kGravity);
    return {angular_velocity(t), attitude(t).conjugate() * (acceleration(t) + up)};
  }
};

inline Matrix6d pose_covariance(double position_sigma, double attitude_sigma) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(position_sigma * position_sigma),
      Eigen::Vector3d::Constant(attitude_sigma * attitude_sigma);
  return variances.asDiagonal();
}

/// What a sensor is off by, beside its white noise.
struct Biases {
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();  ///< of the measured position
};

/// The pose of the motion, with noise of the given covariance where `noise` is given.
inline PoseMeasurement measure(const Motion& motion, double t, const Matrix6d& covariance,
                               Noise* noise = nullptr) {
  Vector6d n = Vector6d::Zero();
  if (noise != nullptr) {
    for (int i = 0; i < 6; ++i) n(i) = (*noise)();
    n = (covariance.llt().matrixL() * n).eval();
  }
  return {motion.position(t) + n.head<3>(), exp_so3(n.tail<3>()) * motion.attitude(t), covariance};
}

inline ImuSample noisy(ImuSample imu, const PoseImuUkf::Params& params, double dt,
                       const Biases& biases, Noise& noise) {
  imu.angular_velocity += biases.gyroscope + params.gyro_noise / std::sqrt(dt) * noise.vector();
  imu.specific_force +=
      biases.accelerometer + params.accelerometer_noise / std::sqrt(dt) * noise.vector();
  return imu;
}

/// Error of the filter in the coordinates of its covariance.
inline PoseImuUkf::ErrorVector error_of(const PoseImuUkf& filter, const Motion& motion, double t,
                                        const Biases& biases) {
  const RigidBodyState state = filter.state();
  PoseImuUkf::ErrorVector error;
  error << motion.position(t) - state.p_WB, motion.velocity(t) - state.v_WB_W,
      log_so3(motion.attitude(t) * state.q_WB.conjugate()),
      biases.accelerometer - filter.accelerometer_bias(), biases.gyroscope - filter.gyro_bias(),
      biases.drift - filter.drift();
  return error;
}

}  // namespace swiftlet::test
