// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Limits of the simple modes' references.
struct ReferenceLimits {
  double velocity = 1.0;          ///< [m/s]
  double acceleration = 1.5;      ///< [m/s^2]
  double jerk = 6.0;              ///< [m/s^3]
  double yaw_acceleration = 2.0;  ///< of a brake [rad/s^2]
  double yaw_jerk = 10.0;         ///< of a brake [rad/s^3]
};

/// Reference of the modes that need no planner (take-off, descent, hold, brake): a smooth function
/// of time with at most three polynomial pieces, then rest.
///
/// Position, velocity, acceleration and jerk are continuous where the reference starts at rest;
/// snap is bounded. A brake starts with the velocity and acceleration that it is given and a jerk
/// of zero.
class FlightReference {
 public:
  /// Rest at the origin.
  FlightReference() = default;

  /// Rest at `position` [m] with heading `yaw` [rad].
  static Result<FlightReference> hold(const Eigen::Vector3d& position, double yaw);

  /// From rest at `from` to rest at `to` on a straight line within velocity, acceleration and
  /// jerk limits, heading kept.
  static Result<FlightReference> move(Time start, const Eigen::Vector3d& from,
                                      const Eigen::Vector3d& to, double yaw,
                                      const ReferenceLimits& limits);

  /// From a moving reference to rest, as short as its shape allows within acceleration and jerk
  /// limits. An acceleration beyond the limit at the start is reduced from there, never raised.
  static Result<FlightReference> brake(Time start, const FlatReference& from,
                                       const ReferenceLimits& limits);

  /// The reference at `time`; before the start that of the start, after the end the final rest.
  FlatReference at(Time time) const;

  Time start() const { return start_; }
  Time end() const { return end_; }
  bool finished(Time time) const { return time >= end_; }
  FlatReference final() const { return at(end_); }

  /// The same as a trajectory: what the simple modes fly and what the planner gives are then one
  /// thing.
  Trajectory trajectory() const;

 private:
  static constexpr int kPowers = 7;  // of degree 6 in time: position, yaw
  struct Piece {
    double begin = 0.0;     // since start_ [s]
    double duration = 0.0;  // [s]
    Eigen::Matrix<double, 4, kPowers> coefficients =
        Eigen::Matrix<double, 4, kPowers>::Zero();  // in powers of (t - begin) / duration
  };
  FlatReference evaluate(const Piece& piece, double since_start) const;

  Time start_{};
  Time end_{};
  int pieces_ = 0;
  std::array<Piece, 3> piece_;
  Eigen::Vector4d rest_ = Eigen::Vector4d::Zero();  // final position and yaw
};

}  // namespace swiftlet
