// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/flight_reference.hpp"

namespace swiftlet {

/// From a moving reference to straight sinking at a steady speed, until somebody stops it: the
/// brake of FlightReference, seen from the frame that sinks. Position, velocity and acceleration
/// continue, and no time is lost by stopping first.
class SteadyDescent {
 public:
  /// Sinks from the origin at no speed.
  SteadyDescent() = default;

  /// `speed` [m/s] is positive downwards. Fails where FlightReference::brake does.
  static Result<SteadyDescent> begin(Time start, FlatReference from, double speed,
                                     const ReferenceLimits& limits);

  /// The reference at `time`, not before the start.
  FlatReference at(Time time) const;

 private:
  FlightReference brake_;
  double speed_ = 0.0;  // downwards [m/s]
};

}  // namespace swiftlet
