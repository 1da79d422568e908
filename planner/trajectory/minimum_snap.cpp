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
/// Which of velocity, acceleration and jerk are free at a knot: 1 where they are, 0 where not.
using Free = Eigen::Vector3d;

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
    finite = finite && waypoint.position.allFinite() && std::isfinite(waypoint.yaw) &&
             waypoint.velocity.value_or(Eigen::Vector3d::Zero()).allFinite() &&
             waypoint.acceleration.value_or(Eigen::Vector3d::Zero()).allFinite();
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

/// Writes what the waypoints prescribe into the knots, in units of `mean` seconds, and says whether
/// an inner one prescribes anything. What the last leaves open stays zero.
bool prescribe(const std::vector<Waypoint>& waypoints, double mean, std::vector<Knot>& knots,
               std::vector<Free>& free) {
  bool inner = false;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto set = [&](int order, const std::optional<Eigen::Vector3d>& value) {
      if (!value) return;
      knots[i + 1].row(order).head<3>() = std::pow(mean, order) * value->transpose();
      free[i + 1][order - 1] = 0.0;
      inner = inner || i + 1 < waypoints.size();
    };
    set(1, waypoints[i].velocity);
    set(2, waypoints[i].acceleration);
  }
  return inner;
}

/// Finds the free derivatives of the inner knots, for `Axes` axes from `first` on: stationary in
/// them, block-tridiagonal, from the first knot to the last and back. Knots hold what is given, and
/// zeros where the derivatives are free.
template <int first, int Axes>
bool minimize(const std::vector<Matrix8d>& cost, const std::vector<Free>& free,
              std::vector<Knot>& knots) {
  using Derivatives = Eigen::Matrix<double, 3, Axes>;
  const std::size_t n = cost.size();
  // diagonal[k] x[k] = right[k] - upper x[k + 1], with x the free ones and zeros for the others.
  std::vector<Eigen::LLT<Eigen::Matrix3d>> diagonal(n);
  std::vector<Derivatives> right(n);
  const auto given = [&](std::size_t k) { return knots[k].template block<3, Axes>(1, first); };
  const auto position = [&](std::size_t k) { return knots[k].template block<1, Axes>(0, first); };
  const auto mask = [&](std::size_t row, const Eigen::Matrix3d& block, std::size_t column) {
    return Eigen::Matrix3d(free[row].asDiagonal() * block * free[column].asDiagonal());
  };
  for (std::size_t k = 1; k < n; ++k) {
    const Matrix8d& in = cost[k - 1];
    const Matrix8d& out = cost[k];
    const Eigen::Matrix3d whole = in.block<3, 3>(5, 5) + out.block<3, 3>(1, 1);
    const Eigen::Matrix3d lower = in.block<3, 3>(5, 1), upper = out.block<3, 3>(1, 5);
    // Only ways count, not where they are.
    Derivatives r = -(in.block<3, 1>(5, 4) * (position(k) - position(k - 1)) +
                      out.block<3, 1>(1, 4) * (position(k + 1) - position(k)));
    r -= lower * given(k - 1) + whole * given(k) + upper * given(k + 1);
    r = free[k].asDiagonal() * r;
    Eigen::Matrix3d D = mask(k, whole, k);
    D.diagonal() += Eigen::Vector3d::Ones() - free[k];
    if (k > 1) {
      const Eigen::Matrix3d below = mask(k, lower, k - 1);
      D -= below * diagonal[k - 1].solve(below.transpose());
      r -= below * diagonal[k - 1].solve(right[k - 1]);
    }
    diagonal[k].compute(D);
    right[k] = r;
    if (diagonal[k].info() != Eigen::Success) return false;
  }
  Derivatives next = Derivatives::Zero();
  for (std::size_t k = n - 1; k >= 1; --k) {
    Derivatives r = right[k];
    if (k + 1 < n) r -= mask(k, cost[k].block<3, 3>(1, 5), k + 1) * next;
    next = diagonal[k].solve(r);
    knots[k].template block<3, Axes>(1, first) += next;
  }
  return true;
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

  // Yaw is prescribed nowhere, so that it goes with the position only where that is not either.
  std::vector<Free> free(n + 1, Free::Ones());
  const bool constrained = prescribe(waypoints, mean, knots, free);
  const bool solved =
      constrained ? minimize<kX, 3>(cost, free, knots) &&
                        minimize<kYaw, 1>(cost, std::vector<Free>(n + 1, Free::Ones()), knots)
                  : minimize<kX, 4>(cost, free, knots);
  if (!solved) {
    return Error{"the durations of neighbouring pieces differ too much for a solution"};
  }

  std::vector<TrajectorySegment> segments(n);
  for (std::size_t i = 0; i < n; ++i) {
    segments[i].duration_s = durations_s[i];
    Eigen::Matrix<double, 8, 4> ends;
    const Eigen::Vector4d scale = time_powers(durations_s[i] / mean);
    ends << scale.asDiagonal() * knots[i], scale.asDiagonal() * knots[i + 1];
    // From the place where it begins, so that rounding goes with the way.
    ends.row(4) -= ends.row(0);
    ends.row(0).setZero();
    Eigen::Matrix<double, 8, 4> c = A * ends;
    c.row(0) = knots[i].row(0);
    for (int axis = 0; axis < 4; ++axis) {
      segments[i].coefficients[static_cast<std::size_t>(axis)].head<8>() = c.col(axis);
    }
  }
  Trajectory trajectory(start_time, std::move(segments));
  if (trajectory.empty()) return Error{"the trajectory through the waypoints is not finite"};
  return trajectory;
}

double snap_cost(const Trajectory& trajectory, double yaw_weight) {
  double total = 0.0;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    for (int axis = kX; axis <= kYaw; ++axis) {
      const Polynomial snap =
          differentiate(segment.coefficients[static_cast<std::size_t>(axis)], 4);
      double integral = 0.0;
      for (int i = 0; i + 4 < kCoefficients; ++i) {
        for (int j = 0; j + 4 < kCoefficients; ++j) integral += snap[i] * snap[j] / (i + j + 1);
      }
      total += (axis == kYaw ? yaw_weight : 1.0) * integral / std::pow(segment.duration_s, 7);
    }
  }
  return total;
}

}  // namespace swiftlet
