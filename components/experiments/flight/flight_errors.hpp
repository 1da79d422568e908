// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "components/experiments/flight/reference_flight.hpp"

namespace swiftlet {

/// Root mean square of what `error(moment)` gives, in each axis, over the moments from `from_s` to
/// `to_s`. Zero where there is none.
template <class Moment, class Error>
Eigen::Vector3d rmse(const std::vector<Moment>& moments, double from_s, double to_s, Error error) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Moment& moment : moments) {
    if (moment.t < from_s || moment.t > to_s) continue;
    sum += Eigen::Vector3d(error(moment)).cwiseAbs2();
    ++count;
  }
  return (sum / std::max(1, count)).cwiseSqrt();
}

/// Psi = tr(I - Rd^T R) / 2, the error of orientation of seed 000 (Bullo and Lewis): 1 - cos of the
/// angle between them.
double psi(const Eigen::Quaterniond& q, const Eigen::Quaterniond& q_d);

/// Root mean square of psi.
template <class Moment, class Attitudes>
double psi_rmse(const std::vector<Moment>& moments, double from_s, double to_s,
                Attitudes attitudes) {
  return rmse(moments, from_s, to_s,
              [&attitudes](const Moment& moment) {
                const auto [q, q_d] = attitudes(moment);
                return Eigen::Vector3d(psi(q, q_d), 0.0, 0.0);
              })
      .x();
}

/// Normalised squared errors of the estimate, 6 and 3 degrees of freedom.
double pose_nees(const FlightMoment& moment);
double velocity_nees(const FlightMoment& moment);

/// Seconds from `released_s` until `position(moment)` is within `radius` [m] of `home` to stay
/// there until `until_s`; infinite where it never is.
template <class Position>
double recovery_s(const std::vector<FlightMoment>& moments, double released_s, double until_s,
                  const Eigen::Vector3d& home, double radius, Position position) {
  double last_outside = released_s, last = released_s;
  for (const FlightMoment& moment : moments) {
    if (moment.t < released_s || moment.t > until_s) continue;
    last = moment.t;
    if ((position(moment) - home).norm() > radius) last_outside = moment.t;
  }
  if (last_outside > released_s && last_outside >= last) {
    return std::numeric_limits<double>::infinity();
  }
  return last_outside - released_s;
}

}  // namespace swiftlet
