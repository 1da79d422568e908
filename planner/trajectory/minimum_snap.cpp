// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/minimum_snap.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;
/// Position to jerk of the four axes (one column each) at a knot.
using Knot = Eigen::Matrix4d;
/// Velocity, acceleration and jerk of the four axes.
using FreeKnot = Eigen::Matrix<double, 3, 4>;

/// Coefficients of degree 7 from position, velocity, acceleration and jerk at s = 0 and s = 1.
Matrix8d coefficients_from_ends() {
  Matrix8d A;
  A << 1, 0, 0, 0, 0, 0, 0, 0,                                     //
      0, 1, 0, 0, 0, 0, 0, 0,                                      //
      0, 0, 1.0 / 2, 0, 0, 0, 0, 0,                                //
      0, 0, 0, 1.0 / 6, 0, 0, 0, 0,                                //
      -35, -20, -5, -2.0 / 3, 35, -15, 5.0 / 2, -1.0 / 6,          //
      84, 45, 10, 1, -84, 39, -7, 1.0 / 2,                         //
      -70, -36, -15.0 / 2, -2.0 / 3, 70, -34, 13.0 / 2, -1.0 / 2,  //
      20, 10, 2, 1.0 / 6, -20, 10, -2, 1.0 / 6;
  return A;
}

/// Integral over [0, 1] of the squared fourth derivative, as a quadratic form of the ends.
Matrix8d snap_cost_of_ends(const Matrix8d& A) {
  Matrix8d Q = Matrix8d::Zero();
  const auto falling = [](int i) { return static_cast<double>(i * (i - 1) * (i - 2) * (i - 3)); };
  for (int i = 4; i < 8; ++i) {
    for (int j = 4; j < 8; ++j) Q(i, j) = falling(i) * falling(j) / (i + j - 7);
  }
  return A.transpose() * Q * A;
}

/// diag(1, T, T^2, T^3): derivatives in time to derivatives in normalised time.
Eigen::Vector4d time_powers(double T) {
  return {1.0, T, T * T, T * T * T};
}

Status check(const FlatReference& start, const std::vector<Waypoint>& waypoints) {
  bool finite = start.position.allFinite() && start.velocity.allFinite() &&
                start.acceleration.allFinite() && start.jerk.allFinite() &&
                std::isfinite(start.yaw) && std::isfinite(start.yaw_rate) &&
                std::isfinite(start.yaw_acceleration);
  if (!finite) return Error{"the start of the trajectory is not finite"};
  if (waypoints.empty()) return Error{"a trajectory needs a waypoint to fly to"};
  for (const Waypoint& waypoint : waypoints) {
    finite = finite && waypoint.position.allFinite() && std::isfinite(waypoint.yaw);
  }
  if (!finite) return Error{"a waypoint is not finite"};
  return {};
}

Knot knot_of(const FlatReference& start) {
  Knot knot;
  knot.row(0) << start.position.transpose(), start.yaw;
  knot.row(1) << start.velocity.transpose(), start.yaw_rate;
  knot.row(2) << start.acceleration.transpose(), start.yaw_acceleration;
  knot.row(3) << start.jerk.transpose(), 0.0;
  return knot;
}

}  // namespace

Result<Trajectory> minimum_snap(Time start_time, const FlatReference& start,
                                const std::vector<Waypoint>& waypoints,
                                const std::vector<double>& durations_s) {
  if (Status status = check(start, waypoints); !status) return status.error();
  const std::size_t n = waypoints.size();
  if (durations_s.size() != n) return Error{"a trajectory needs one duration a waypoint"};
  double mean = 0.0;
  for (const double duration : durations_s) {
    if (!(duration > 1e-6 && duration < 3600.0)) {
      return Error{fmt::format("{} s is no duration for a piece of a trajectory", duration)};
    }
    mean += duration / static_cast<double>(n);
  }

  // Knots in units of the mean duration, which keeps the system well scaled.
  std::vector<Knot> knots(n + 1, Knot::Zero());
  knots[0] = time_powers(mean).asDiagonal() * knot_of(start);
  double yaw = start.yaw;
  for (std::size_t i = 0; i < n; ++i) {
    yaw += wrap_angle(waypoints[i].yaw - yaw);
    knots[i + 1].row(0) << waypoints[i].position.transpose(), yaw;
  }

  // Cost of each piece as a quadratic form of its two knots: T^-7 D Q D.
  const Matrix8d A = coefficients_from_ends();
  const Matrix8d Q = snap_cost_of_ends(A);
  std::vector<Matrix8d> cost(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double T = durations_s[i] / mean;
    Vector8d powers;
    powers << time_powers(T), time_powers(T);
    cost[i] = powers.asDiagonal() * Q * powers.asDiagonal() / std::pow(T, 7);
  }

  // Stationary in the free derivatives of the inner knots: block-tridiagonal, from the first knot
  // to the last and back. diagonal[k] x[k] = right[k] - upper x[k + 1].
  std::vector<Eigen::LLT<Eigen::Matrix3d>> diagonal(n);
  std::vector<FreeKnot> right(n);
  for (std::size_t k = 1; k < n; ++k) {
    const Matrix8d& in = cost[k - 1];
    const Matrix8d& out = cost[k];
    Eigen::Matrix3d D = in.block<3, 3>(5, 5) + out.block<3, 3>(1, 1);
    FreeKnot r = -(in.block<3, 1>(5, 0) * knots[k - 1].row(0) +
                   (in.block<3, 1>(5, 4) + out.block<3, 1>(1, 0)) * knots[k].row(0) +
                   out.block<3, 1>(1, 4) * knots[k + 1].row(0));
    if (k == 1) {
      r -= in.block<3, 3>(5, 1) * knots[0].bottomRows<3>();
    } else {
      const Eigen::Matrix3d lower = in.block<3, 3>(5, 1);
      D -= lower * diagonal[k - 1].solve(lower.transpose());
      r -= lower * diagonal[k - 1].solve(right[k - 1]);
    }
    diagonal[k].compute(D);
    right[k] = r;
    if (diagonal[k].info() != Eigen::Success) {
      return Error{"the durations of neighbouring pieces differ too much for a solution"};
    }
  }
  for (std::size_t k = n - 1; k >= 1; --k) {
    FreeKnot r = right[k];
    if (k + 1 < n) r -= cost[k].block<3, 3>(1, 5) * knots[k + 1].bottomRows<3>();
    knots[k].bottomRows<3>() = diagonal[k].solve(r);
  }

  std::vector<TrajectorySegment> segments(n);
  for (std::size_t i = 0; i < n; ++i) {
    segments[i].duration_s = durations_s[i];
    Eigen::Matrix<double, 8, 4> ends;
    const Eigen::Vector4d scale = time_powers(durations_s[i] / mean);
    ends << scale.asDiagonal() * knots[i], scale.asDiagonal() * knots[i + 1];
    const Eigen::Matrix<double, 8, 4> c = A * ends;
    for (int axis = 0; axis < 4; ++axis) {
      segments[i].coefficients[static_cast<std::size_t>(axis)].head<8>() = c.col(axis);
    }
  }
  Trajectory trajectory(start_time, std::move(segments));
  if (trajectory.empty()) return Error{"the trajectory through the waypoints is not finite"};
  return trajectory;
}

}  // namespace swiftlet
