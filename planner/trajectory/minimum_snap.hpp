// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Where a trajectory leads through.
struct Waypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< [rad], turned to over the shorter side
};

/// The trajectory that minimises the integral of the squared snap, the cost functional of seed 000
/// ("Autonomous Navigation"; Mellinger and Kumar 2011), through waypoints at given times.
///
/// It starts with the position, velocity, acceleration and jerk (and yaw, yaw rate, yaw
/// acceleration) of `start`, passes the waypoints and ends at rest at the last. Free are velocity,
/// acceleration and jerk at the inner waypoints (Richter, Bry and Roy 2013, section 3, whose
/// unconstrained form this is). Pieces have degree 7, and the minimum is continuous up to the sixth
/// derivative. Solved as a block-tridiagonal system, at a cost linear in the waypoints.
///
/// `durations_s` has one entry a waypoint: the time of the piece that ends in it. Fails where a
/// number is not finite or a duration is not positive.
Result<Trajectory> minimum_snap(Time start_time, const FlatReference& start,
                                const std::vector<Waypoint>& waypoints,
                                const std::vector<double>& durations_s);

/// Chooses the times so that limits hold.
class MinimumSnapPlanner {
 public:
  struct Params {
    double max_speed = 1.0;         ///< [m/s]
    double max_acceleration = 1.0;  ///< [m/s^2]
    double max_yaw_rate = 1.0;      ///< [rad/s], of the allocation
    /// Share of the limits that times are chosen to leave free, for a later trajectory that starts
    /// on this one in flight. It may be used up by such a start, the limits are never exceeded.
    double reserve = 0.1;
    double min_duration_s = 0.1;  ///< of a piece
    int balance_rounds = 6;       ///< of moving time between pieces
    int max_iterations = 60;      ///< of stretching all of them
  };

  MinimumSnapPlanner();
  explicit MinimumSnapPlanner(const Params& params);

  /// Minimum-snap trajectory through the waypoints with speed and acceleration within the limits at
  /// every moment. Times start from a trapezoidal speed profile that slows down in turns, are
  /// shifted to the pieces that need them most, and are stretched together until no limit is
  /// broken.
  ///
  /// The derivatives of the start are kept as they are. Where stretching does not help, since
  /// longer pieces only give the acceleration of the start more time to act, a short first piece
  /// ends acceleration and jerk, and the minimum starts from there (continuous up to the jerk).
  /// Fails when the start itself breaks a limit or nothing of this helps.
  Result<Trajectory> plan(Time start_time, const FlatReference& start,
                          const std::vector<Waypoint>& waypoints) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
};

}  // namespace swiftlet
