// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"

namespace swiftlet {

/// One triad of an inertial unit, in the unit U of what it measures (rad/s or m/s^2).
struct InertialTriad {
  double noise_density = 0.0;     ///< white noise [U/sqrt(Hz)]
  double bias = 0.0;              ///< standard deviation of the bias at the start, per axis [U]
  double bias_random_walk = 0.0;  ///< [U/s/sqrt(Hz)]
  double range = 0.0;             ///< saturates at +-range [U]
  double resolution = 0.0;        ///< of the converter [U]; zero for none
};

struct ImuReading {
  Time time{};
  ImuSample sample;  ///< in the sensor's frame
};

/// Gyroscope and accelerometer: the true motion of the place where the sensor is mounted (lever
/// arm included), plus bias (constant and random walk) and white noise with the standard deviation
/// density * sqrt(rate), then saturation and quantisation.
class ImuSensor {
 public:
  struct Params {
    double rate_hz = 1000.0;
    InertialTriad gyroscope;
    InertialTriad accelerometer;
    Mount mount;
  };
  /// Typical figures of the data sheets, biases as they are left after calibration at rest.
  static Params mpu6000();  ///< imu0 of seed 004, 1000 Hz
  static Params l3gd20h();  ///< imu1 of seed 004, 200 Hz
  static Params bno055();   ///< imu2 of seed 004, 20 Hz

  ImuSensor(const Params& params, RandomStream random);

  /// The reading that is due at the time of `truth`, or null. Valid until the next call.
  const ImuReading* update(const VehicleTruth& truth);
  const Params& params() const { return params_; }

 private:
  Params params_;
  RandomStream random_;
  SampleClock clock_;
  Eigen::Vector3d gyroscope_bias_;
  Eigen::Vector3d accelerometer_bias_;
  ImuReading reading_;
};

}  // namespace swiftlet
