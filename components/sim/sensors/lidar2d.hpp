// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"
#include "components/sim/world.hpp"

namespace swiftlet {

/// One turn of a laser scanner. Beam i points at angle_min + i * angle_increment about z of the
/// sensor, from its x axis.
struct LaserScanReading {
  Time time{};
  double angle_min = 0.0;        ///< [rad]
  double angle_increment = 0.0;  ///< [rad]
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]
  /// [m]; by REP-117, +infinity is a beam without a return and -infinity one that met something
  /// nearer than `range_min`.
  std::vector<float> ranges;
};

/// A 2D laser scanner over 360 degrees, as the RPLIDAR A1 of seed 004 (1000 beams, 12 m, 2 mm).
/// The plane of the beams is that of the body: tilt shows. All beams of a scan are taken at one
/// moment; distortion by motion during the turn is not modelled.
class Lidar2d {
 public:
  struct Params {
    double rate_hz = 10.0;
    int beams = 1000;
    double range_min = 0.15;             ///< [m]
    double range_max = 12.0;             ///< [m]
    double noise_stddev = 0.01;          ///< [m]
    double resolution = 0.002;           ///< [m]
    double dropout_probability = 0.002;  ///< of each beam [1]
    Mount mount{{0.0, 0.0, 0.08}, Eigen::Quaterniond::Identity()};
  };

  Lidar2d(const Params& params, RandomStream random);

  /// The scan that is due at the time of `truth`, or null. Valid until the next call.
  const LaserScanReading* update(const VehicleTruth& truth, const World& world);
  const Params& params() const { return params_; }

 private:
  Params params_;
  RandomStream random_;
  SampleClock clock_;
  Eigen::Matrix3Xd beams_S_;  ///< unit vectors in the sensor's frame
  Eigen::Matrix3Xd beams_W_;
  std::vector<double> true_ranges_;
  LaserScanReading reading_;
};

}  // namespace swiftlet
