// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"
#include "estimation/geodesy/local_origin.hpp"

namespace swiftlet {

struct GpsReading {
  Time time{};
  GlobalPosition position;
  double horizontal_stddev = 0.0;  ///< of east and of north [m]
  double vertical_stddev = 0.0;    ///< [m]
};

/// Global position with white errors, in a world that says where on Earth it is. Of a receiver as
/// it is (bias, multipath, satellites, velocity) it has nothing yet.
class GpsSensor {
 public:
  struct Params {
    double rate_hz = 5.0;
    double horizontal_stddev = 0.5;  ///< [m]
    double vertical_stddev = 1.0;    ///< [m]
  };

  /// Without an origin there is no reception.
  GpsSensor(const Params& params, const std::optional<LocalOrigin>& origin, RandomStream random);

  /// The fix at the time of `truth`, or null. Valid until the next call.
  const GpsReading* update(const VehicleTruth& truth);

 private:
  Params params_;
  std::optional<LocalOrigin> origin_;
  RandomStream random_;
  SampleClock clock_;
  GpsReading reading_;
};

}  // namespace swiftlet
