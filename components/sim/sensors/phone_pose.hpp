// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"

namespace swiftlet {

struct PhonePoseReading {
  Time time{};  ///< when the pose was taken; it is handed out `latency_ms` later
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_WS [m]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< q_WS
  Eigen::Vector3d position_stddev = Eigen::Vector3d::Zero();     ///< true figure of the errors [m]
  Eigen::Vector3d attitude_stddev = Eigen::Vector3d::Zero();     ///< about the axes of W [rad]
};

/// Pose from the visual-inertial odometry of a smartphone, with the errors of the Tango phone in
/// Table 2 of seed 000.
///
/// Position: half of the variance is white, half is drift (first-order Gauss-Markov, in its
/// stationary state from the start).
/// Attitude: q_WS = exp(n) q_true with n white and normal in W. Table 2 gives the RMSE of
/// Psi = tr(I - Rd^T R) / 2 = 1 - cos|n|, 0.0627. For small n, Psi = |n|^2 / 2 and
///   E[Psi^2] = ((sx^2 + sy^2 + sz^2)^2 + 2 (sx^4 + sy^4 + sz^4)) / 4.
/// A phone sees gravity, so tilt is known well (sx = sy = 0.02 rad) and heading carries the rest:
/// the small-angle formula gives sz = 0.2686 rad, the exact expectation of (1 - cos|n|)^2, which
/// the default has, 0.2727 rad.
class PhonePoseSensor {
 public:
  struct Params {
    double rate_hz = 30.0;
    Eigen::Vector3d position_rmse{0.0165, 0.0320, 0.0274};  ///< per axis of W [m]
    double drift_fraction = 0.5;                            ///< of the variance that is drift [1]
    double drift_time_constant = 10.0;                      ///< [s]
    double tilt_stddev = 0.02;                              ///< about x and y of W [rad]
    double yaw_stddev = 0.2727;                             ///< about z of W [rad]
    double drop_probability = 0.0;                          ///< of each pose [1]
    double latency_ms = 0.0;
    Mount mount;
  };

  PhonePoseSensor(const Params& params, RandomStream random);

  /// The pose that arrives at the time of `truth`, or null. Valid until the next call.
  const PhonePoseReading* update(const VehicleTruth& truth);
  const Params& params() const { return params_; }

 private:
  PhonePoseReading measure(const VehicleTruth& truth);

  Params params_;
  RandomStream random_;
  SampleClock clock_;
  Eigen::Vector3d drift_;
  Time drift_time_{};
  std::vector<PhonePoseReading> on_the_way_;  ///< ring, as long as the latency needs
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  PhonePoseReading reading_;
};

}  // namespace swiftlet
