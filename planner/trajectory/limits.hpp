// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "estimation/basics/result.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// What a multirotor on a trajectory must keep to at every moment. What is infinite (for the least
/// thrust: zero) limits nothing.
struct TrajectoryLimits {
  double max_speed = 1.0;         ///< [m/s]
  double max_acceleration = 1.0;  ///< [m/s^2]
  /// Collective thrust per mass |a + g e3| [m/s^2]; hovering takes kGravity, so the limits must
  /// leave that between them.
  double max_thrust_per_mass = std::numeric_limits<double>::infinity();
  double min_thrust_per_mass = 0.0;  ///< [m/s^2]
  /// Norm of the body's angular velocity, see body_rate.hpp [rad/s].
  double max_body_rate = std::numeric_limits<double>::infinity();
  double max_yaw_rate = std::numeric_limits<double>::infinity();  ///< of the heading [rad/s]
};

/// The limits with a share of their room, from standing still to the limit. 1 gives the limits.
TrajectoryLimits share_of(const TrajectoryLimits& limits, double share);

/// Limits that a hover keeps, with room to fly.
Status check(const TrajectoryLimits& limits);

/// What a trajectory takes at most; at first, what a hover takes.
struct TrajectoryExtrema {
  double max_speed = 0.0;                 ///< [m/s]
  double max_acceleration = 0.0;          ///< [m/s^2]
  double max_thrust_per_mass = kGravity;  ///< [m/s^2]
  double min_thrust_per_mass = kGravity;  ///< [m/s^2]
  double max_body_rate = 0.0;             ///< [rad/s]
  double max_yaw_rate = 0.0;              ///< [rad/s]
};

/// Bounds that hold at every moment, at most 1e-6 (relative) beside a value that is taken: from the
/// Bernstein form of the polynomials, never from samples.
TrajectoryExtrema extrema(const TrajectorySegment& segment);
TrajectoryExtrema extrema(const Trajectory& trajectory);
/// The values of one moment.
TrajectoryExtrema extrema(const FlatReference& reference);

/// The largest share of any limit's room that is used; above 1 where a limit is broken.
double usage(const TrajectoryExtrema& extrema, const TrajectoryLimits& limits);

/// Names the limits that are broken: "the speed reaches 1.3 m/s, above the limit of 1 m/s".
Status within(const TrajectoryExtrema& extrema, const TrajectoryLimits& limits);
Status within(const TrajectorySegment& segment, const TrajectoryLimits& limits);

/// By how much the segment would have to last longer to keep the limits, about; at most 1 exactly
/// where it keeps them. Right for speed, acceleration, yaw rate and (nearly) thrust on a path that
/// stays the same; the body rate may ask several times.
double needed_stretch(const TrajectorySegment& segment, const TrajectoryLimits& limits);

}  // namespace swiftlet
