// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {

/// A speed profile along the straight lines between the waypoints.
struct SpeedProfile {
  double max_speed = 1.0;         ///< [m/s]
  double max_acceleration = 1.0;  ///< [m/s^2], which smooth ramps peak at
  double yaw_rate = 1.0;          ///< [rad/s], about which the yaw turns at most
  double min_duration_s = 0.1;    ///< of a piece
};

/// Durations of the pieces from a trapezoidal speed profile that is slow where the path turns and
/// that can be braked for, ahead of every turn. A first guess that needs no solution.
std::vector<double> trapezoid_durations(const FlatReference& start,
                                        const std::vector<Waypoint>& waypoints,
                                        const SpeedProfile& profile);

/// How the snap cost (with yaw weighted by `yaw_weight`, see snap_cost()) of a minimum-snap
/// trajectory changes with the duration of each piece, in cost per second. Since the minimum is
/// stationary in the derivatives at the waypoints, only the piece itself counts: it is the
/// Hamiltonian of the piece, constant along it, -s^2 + 2 s' j - 2 s'' a + 2 s''' v summed over the
/// axes, with snap s, jerk j, acceleration a and velocity v.
std::vector<double> snap_cost_slopes(const Trajectory& minimum, double yaw_weight);

/// How the durations of least snap are found.
struct LeastSnapParams {
  /// What a radian of yaw weighs beside a metre [m^2/rad^2]. More than zero, so that a turn on the
  /// spot gets time too.
  double yaw_weight = 0.1;
  /// No piece gets less than this share of the mean duration.
  double least_share = 0.02;
  int max_iterations = 200;
  /// Ends where the cost changes by no more than this (relative), for a change of any duration by
  /// its own size.
  double tolerance = 1e-6;
};

/// The durations, `total_s` together, that give minimum_snap() the least cost: time moves between
/// the pieces down the slopes of the cost (Mellinger and Kumar 2011, section IV), by steps of
/// Barzilai and Borwein (1988) that must lower the cost. The better of equal and trapezoidal
/// durations is where it starts, so that it is never worse than either.
Result<std::vector<double>> least_snap_durations(const FlatReference& start,
                                                 const std::vector<Waypoint>& waypoints,
                                                 double total_s,
                                                 const LeastSnapParams& params = {});

}  // namespace swiftlet
