// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "control/flight_reference.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// The sticks of a remote control, as seen from the vehicle (FLU), each from -1 to 1.
struct Sticks {
  double forward = 0.0;
  double left = 0.0;
  double up = 0.0;
  double turn = 0.0;      ///< counter-clockwise seen from above
  bool assisted = false;  ///< the switch: take over into Assisted Manual rather than Manual

  /// How far the stick is that is farthest from its centre; NaN where one is no number.
  double deflection() const;
};

/// What full sticks ask for, and how fast it comes.
struct SteeringLimits {
  double speed = 1.0;             ///< horizontal [m/s]
  double climb_speed = 0.5;       ///< [m/s]
  double turn_rate = 0.8;         ///< [rad/s]
  double acceleration = 1.5;      ///< [m/s^2]
  double jerk = 8.0;              ///< [m/s^3]
  double snap = 120.0;            ///< [m/s^4]
  double yaw_acceleration = 2.0;  ///< [rad/s^2]
  double yaw_jerk = 20.0;         ///< [rad/s^3]
  double dead_band = 0.05;        ///< of a stick around its centre

  bool usable() const;
};

/// A velocity that is asked for.
struct Steering {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< in the world [m/s]
  double yaw_rate = 0.0;                               ///< [rad/s]
};

/// What sticks ask of a vehicle with that heading [rad]; diagonal sticks are no faster than
/// straight ones. Sticks within the dead band ask for nothing, and from its edge on they ask from
/// zero.
Steering steering(const Sticks& sticks, double yaw, const SteeringLimits& limits);

/// From a moving reference towards a velocity for a while, and then to rest with `braking`: who
/// falls silent leaves a vehicle that stops. Empty where anything is no number.
///
/// Called again within `lasting` with what is flown by then, the velocity comes without overshoot,
/// with continuous jerk and within the limits (acceleration and jerk to a tenth): a chain of three
/// bounded steps from the error of the velocity to its third derivative.
Trajectory steer(Time now, Duration lasting, const FlatReference& from, const Steering& wanted,
                 const SteeringLimits& limits, const ReferenceLimits& braking);

/// The rate at which an error shall go down: `gain` times a small one; a large one goes down so
/// fast that `slope`, as the rate's own change, brings both to zero together.
double easing(double error, double gain, double slope);

}  // namespace swiftlet
