// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"
#include "components/sim/world.hpp"

namespace swiftlet {

struct RangeReading {
  Time time{};
  double range = 0.0;          ///< [m]; +infinity without an echo
  double range_min = 0.0;      ///< [m]; nearer things read as this
  double range_max = 0.0;      ///< [m]
  double field_of_view = 0.0;  ///< full angle of the cone [rad]
};

/// Ultrasonic ranger as the LV-EZ1 of seed 004, looking along -z of its frame: the nearest surface
/// within a cone, to the inch.
class Sonar {
 public:
  struct Params {
    double rate_hz = 20.0;
    double range_min = 0.15;           ///< [m]
    double range_max = 6.45;           ///< [m]
    double cone_half_angle = 0.26;     ///< [rad]
    double noise_stddev = 0.01;        ///< [m]
    double resolution = 0.0254;        ///< [m]
    double dropout_probability = 0.0;  ///< of each reading [1]
    Mount mount{{0.0, 0.0, -0.05}, Eigen::Quaterniond::Identity()};
  };

  Sonar(const Params& params, RandomStream random);

  /// The reading that is due at the time of `truth`, or null. Valid until the next call.
  const RangeReading* update(const VehicleTruth& truth, const World& world);
  const Params& params() const { return params_; }

 private:
  Params params_;
  RandomStream random_;
  SampleClock clock_;
  Eigen::Matrix3Xd rays_S_;  ///< unit vectors that fill the cone
  Eigen::Matrix3Xd rays_W_;
  std::vector<double> ranges_;
  RangeReading reading_;
};

}  // namespace swiftlet
