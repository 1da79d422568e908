// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "control/steady_descent.hpp"

namespace swiftlet {

/// What the downward sonar says of the ground, as long as it says anything. Every reading counts
/// from the step at which it is there first.
class GroundSonar {
 public:
  struct Params {
    double ground_range = 0.18;  ///< it reads less on the ground [m]
    double timeout = 0.25;       ///< five periods of 20 Hz [s]
  };

  explicit GroundSonar(const Params& params) : params_(params) {}
  void set_params(const Params& params) { params_ = params; }

  /// What is no number is ignored. No echo is an infinite range.
  void set_range(double range);
  void step(Time now);

  /// Whether there is a sonar that speaks.
  bool heard() const { return heard_; }
  /// For how long each reading was one of the ground [s]; nothing where the last one is not.
  std::optional<double> near_ground_for() const { return near_for_; }

 private:
  Params params_;
  std::optional<double> range_;
  bool is_new_ = false;
  bool heard_ = false;
  std::optional<Time> heard_at_;
  std::optional<Time> near_since_;
  std::optional<double> near_for_;
};

/// The rest of a flight whose commander is gone, while the vehicle knows where it is: brake, hold,
/// and after a while go down until the ground resists.
///
/// Resistance is how far the vehicle stays above a reference that sinks. Where the sonar sees the
/// ground, too, little is enough; where there is no sonar, it takes more; against a sonar that sees
/// no ground, so much that the controller has cut the thrust to its minimum long since: what does
/// not fall then stands on something.
class AbandonedFlight {
 public:
  struct Params {
    ReferenceLimits braking{1.0, 4.0, 30.0, 2.0, 10.0};
    double timeout = 3.0;             ///< then it lands [s]
    double landing_speed = 0.4;       ///< [m/s]
    double resistance = 0.10;         ///< where the sonar sees the ground [m]
    double resistance_alone = 0.40;   ///< where there is no sonar [m]
    double resistance_against = 1.0;  ///< where it sees none [m]
  };

  /// Throws std::invalid_argument where a parameter cannot be used.
  explicit AbandonedFlight(const Params& params);
  /// Does not touch the reference that is flown. Throws as the constructor.
  void set_params(const Params& params);

  /// Begins at `now` with the reference that is flown. `since` is when the commander was missed
  /// first: it may be long ago where the estimate was missing, too. Fails, and changes nothing,
  /// where FlightReference::brake does.
  Status begin(Time since, Time now, const FlatReference& flown);

  /// What to fly at `now`. Decides when to land.
  FlatReference reference(Time now);
  bool landing() const { return landing_; }

  /// Whether a vehicle at `height`, in the world [m], has landed.
  bool landed(Time now, double height, const GroundSonar& sonar) const;

 private:
  FlatReference flown(Time now) const { return landing_ ? descent_.at(now) : brake_.at(now); }

  Params params_;
  Time since_{};
  FlightReference brake_;
  SteadyDescent descent_;
  bool landing_ = false;
};

}  // namespace swiftlet
