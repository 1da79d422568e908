// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/imu.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

using Eigen::Vector3d;

namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kMicroG = 1e-6 * kGravity;

/// Truth to reading; moves the bias on by one sample.
Vector3d measure(const Vector3d& truth, const InertialTriad& triad, double rate_hz, Vector3d& bias,
                 RandomStream& random) {
  bias += triad.bias_random_walk / std::sqrt(rate_hz) * random.normal3();
  Vector3d value = truth + bias + triad.noise_density * std::sqrt(rate_hz) * random.normal3();
  for (double& axis : value) {
    if (triad.range > 0.0) axis = std::clamp(axis, -triad.range, triad.range);
    axis = quantised(axis, triad.resolution);
  }
  return value;
}

}  // namespace

ImuSensor::Params ImuSensor::mpu6000() {
  Params params;
  params.rate_hz = 1000.0;
  params.gyroscope = {0.005 * kDegree, 0.003, 2e-5, 2000.0 * kDegree, kDegree / 16.4};
  params.accelerometer = {400.0 * kMicroG, 0.05, 3e-4, 16.0 * kGravity, kGravity / 2048.0};
  return params;
}

ImuSensor::Params ImuSensor::l3gd20h() {
  // The L3GD20H is a gyroscope alone; the accelerometer is that of the LSM303D, its usual partner.
  Params params;
  params.rate_hz = 200.0;
  params.gyroscope = {0.011 * kDegree, 0.003, 2e-5, 2000.0 * kDegree, 0.07 * kDegree};
  params.accelerometer = {150.0 * kMicroG, 0.05, 3e-4, 16.0 * kGravity, 0.732e-3 * kGravity};
  return params;
}

ImuSensor::Params ImuSensor::bno055() {
  Params params;
  params.rate_hz = 20.0;
  params.gyroscope = {0.014 * kDegree, 0.002, 1e-5, 2000.0 * kDegree, kDegree / 16.0};
  params.accelerometer = {150.0 * kMicroG, 0.03, 2e-4, 16.0 * kGravity, 0.01};
  return params;
}

ImuSensor::ImuSensor(const Params& params, RandomStream random)
    : params_(params), random_(random), clock_(params.rate_hz) {
  gyroscope_bias_ = params.gyroscope.bias * random_.normal3();
  accelerometer_bias_ = params.accelerometer.bias * random_.normal3();
}

const ImuReading* ImuSensor::update(const VehicleTruth& truth) {
  if (!clock_.due(truth.time)) return nullptr;
  const Vector3d& w = truth.body.w_WB_B;
  const Vector3d& arm = params_.mount.position;
  const Vector3d force_B =
      truth.specific_force + truth.angular_acceleration.cross(arm) + w.cross(w.cross(arm));
  const Eigen::Quaterniond q_SB = params_.mount.attitude.conjugate();
  reading_.time = truth.time;
  reading_.sample.angular_velocity =
      measure(q_SB * w, params_.gyroscope, params_.rate_hz, gyroscope_bias_, random_);
  reading_.sample.specific_force =
      measure(q_SB * force_B, params_.accelerometer, params_.rate_hz, accelerometer_bias_, random_);
  return &reading_;
}

}  // namespace swiftlet
