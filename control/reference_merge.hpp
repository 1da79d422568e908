// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/flight_reference.hpp"

namespace swiftlet {

/// Leads from the reference that is flown onto another one that moves on by itself, without a step
/// in position, velocity, acceleration or heading: the difference of the two is braked to rest and
/// then undone, both at once, each within limits of its own.
class ReferenceMerge {
 public:
  /// `flown` and `wanted` are those of `start`. Where their difference cannot be undone (it is not
  /// finite, or kilometres), there is nothing to merge and the wanted one is flown as it is.
  void begin(Time start, const FlatReference& flown, const FlatReference& wanted,
             const ReferenceLimits& braking, const ReferenceLimits& undoing);

  /// What to fly at `time` to get to `wanted`, the reference at that time.
  FlatReference apply(Time time, const FlatReference& wanted) const;

  bool finished(Time time) const { return time >= end_; }

 private:
  FlightReference brake_;    // of the difference
  FlightReference undo_;     // from nothing to minus where the brake ends
  FlightReference heading_;  // its x is the heading's: a move by minus the difference
  Time end_{};
};

}  // namespace swiftlet
