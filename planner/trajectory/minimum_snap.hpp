// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Where a trajectory leads through, and how where that matters.
struct Waypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< [rad], turned to over the shorter side
  std::optional<Eigen::Vector3d> velocity = {};        ///< [m/s], where it is prescribed
  std::optional<Eigen::Vector3d> acceleration = {};    ///< [m/s^2], where it is prescribed
};

/// The trajectory that minimises the integral of the squared snap, the cost functional of seed 000
/// ("Autonomous Navigation"; Mellinger and Kumar 2011), through waypoints at given times.
///
/// It starts with the position, velocity, acceleration and jerk (and yaw, yaw rate, yaw
/// acceleration) of `start`, passes the waypoints with the velocity and the acceleration that they
/// prescribe, and ends at the last with what that prescribes and the other derivatives zero: at
/// rest where it prescribes nothing. Free are all other derivatives at the inner waypoints
/// (Richter, Bry and Roy 2013, section 3, whose unconstrained form this is). Pieces have degree 7,
/// and the minimum is continuous up to the sixth derivative; a waypoint that prescribes the
/// velocity costs the continuity of the sixth, one that prescribes the acceleration that of the
/// fifth. Solved as a block-tridiagonal system, at a cost linear in the waypoints.
///
/// `durations_s` has one entry a waypoint: the time of the piece that ends in it. Fails where a
/// number is not finite or a duration is not positive.
Result<Trajectory> minimum_snap(Time start_time, const FlatReference& start,
                                const std::vector<Waypoint>& waypoints,
                                const std::vector<double>& durations_s);

/// The cost of a trajectory: the integral of the squared snap of the position [m^2/s^7]. That of
/// yaw [rad^2/s^7] is minimised beside it and counts with `yaw_weight` [m^2/rad^2].
double snap_cost(const Trajectory& trajectory, double yaw_weight = 0.0);

}  // namespace swiftlet
