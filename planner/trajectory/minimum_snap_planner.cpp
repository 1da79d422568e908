// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "estimation/geometry/so3.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {
namespace {

/// Time to cover a distance from one speed to another, within limits of speed and acceleration.
double trapezoid_s(double distance, double v0, double v1, double v_max, double a_max) {
  const double peak =
      std::min(v_max, std::sqrt(std::max(0.0, a_max * distance + 0.5 * (v0 * v0 + v1 * v1))));
  const double ramps = std::max(0.0, 2 * peak * peak - v0 * v0 - v1 * v1) / (2 * a_max);
  const double cruise = std::max(0.0, distance - ramps) / std::max(peak, 1e-6);
  return std::max(0.0, 2 * peak - v0 - v1) / a_max + cruise;
}

constexpr int kRoundsForReserve = 10;
constexpr double kBalance = 0.5;  // less than 1, since pieces pull at their neighbours

// A first piece that ends acceleration and jerk: how long, and what it keeps of the speed.
constexpr double kLevelling_s[] = {0.3, 0.6, 1.0, 1.6};
constexpr double kBraking[] = {0.5, 0.0};
// In units of the time that braking takes at the limit; a smooth one needs 15/8 of it.
constexpr double kBrakingTimes[] = {2.1, 3.0, 4.5};
// Slower counts as at rest: [m/s], [m/s^2], [m/s^3].
constexpr double kRest = 1e-6;
// Rounds of stretching before levelling is tried.
constexpr int kRoundsInMotion = 15;

/// Velocity, acceleration and jerk of x, y, z and yaw.
using Motion = Eigen::Matrix<double, 3, 4>;

Motion motion_of(const FlatReference& start) {
  Motion motion;
  motion << start.velocity.transpose(), start.yaw_rate, start.acceleration.transpose(),
      start.yaw_acceleration, start.jerk.transpose(), 0.0;
  return motion;
}

/// The piece over `T` seconds to a velocity, without acceleration and jerk, wherever that is: the
/// velocity is the quintic of Hermite, which is the one of least snap.
TrajectorySegment level_out(const FlatReference& start, const Eigen::RowVector4d& velocity,
                            double T) {
  const Motion motion = motion_of(start);
  TrajectorySegment segment;
  segment.duration_s = T;
  for (int axis = 0; axis < 4; ++axis) {
    const double v = motion(0, axis) * T, a = motion(1, axis) * T * T;
    const double j = motion(2, axis) * T * T * T, d = velocity[axis] * T - v;
    // v(s) = v + a s + j s^2 / 2 + ..., integrated.
    segment.coefficients[static_cast<std::size_t>(axis)].head<7>()
        << (axis == kYaw ? start.yaw : start.position[axis]),
        v, a / 2, j / 6, (10 * d - 6 * a - 1.5 * j) / 4, (-15 * d + 8 * a + 1.5 * j) / 5,
        (6 * d - 3 * a - 0.5 * j) / 6;
  }
  return segment;
}

/// First pieces that may help a start in motion, from the fastest to a stop.
std::vector<TrajectorySegment> first_pieces(const FlatReference& start,
                                            const MinimumSnapPlanner::Params& params) {
  const Motion motion = motion_of(start);
  std::vector<TrajectorySegment> pieces;
  for (const double T : kLevelling_s) {
    // The velocity that is reached anyway while acceleration and jerk fade.
    const Eigen::RowVector4d v = motion.row(0) + motion.row(1) * T / 2 + motion.row(2) * T * T / 12;
    pieces.push_back(level_out(start, v, T));
  }
  for (const double keep : kBraking) {
    for (const double times : kBrakingTimes) {
      const double change = (1 - keep) * start.velocity.norm() + 0.3 * params.max_speed;
      const double T = times * change / params.max_acceleration;
      pieces.push_back(level_out(start, keep * motion.row(0), T));
    }
  }
  return pieces;
}

/// By how much every piece would have to be longer to keep its speed and its acceleration.
std::vector<double> loads(const Trajectory& trajectory, double v_max, double a_max) {
  std::vector<double> load;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    load.push_back(std::max({max_derivative_norm(segment, 1) / v_max,
                             std::sqrt(max_derivative_norm(segment, 2) / a_max), 1e-3}));
  }
  return load;
}

/// The share of the limits to aim at: what the reserve leaves, or what the start has already.
double target_share(const FlatReference& start, const MinimumSnapPlanner::Params& params) {
  const double started = std::max(start.velocity.norm() / params.max_speed,
                                  start.acceleration.norm() / params.max_acceleration);
  return std::min(1.0, std::max(1.0 - std::clamp(params.reserve, 0.0, 0.9), 1.02 * started));
}

/// First guess of the durations: a speed profile that is slow where the path turns and that can be
/// braked for, ahead of every turn.
std::vector<double> allocate(const FlatReference& start, const std::vector<Waypoint>& waypoints,
                             double v_max, double a_limit,
                             const MinimumSnapPlanner::Params& params) {
  const std::size_t n = waypoints.size();
  // Smooth ramps peak at about twice the acceleration of straight ones.
  const double a_max = 0.5 * a_limit;
  std::vector<Eigen::Vector3d> points{start.position};
  for (const Waypoint& waypoint : waypoints) points.push_back(waypoint.position);
  std::vector<double> speed(n + 1, 0.0), distance(n);
  for (std::size_t i = 0; i < n; ++i) distance[i] = (points[i + 1] - points[i]).norm();
  speed[0] = std::min(start.velocity.norm(), v_max);
  for (std::size_t i = 1; i < n; ++i) {
    // What the turn allows: a circle that touches both legs as far out as the shorter one reaches.
    const Eigen::Vector3d in = points[i] - points[i - 1], out = points[i + 1] - points[i];
    const double turn = std::atan2(in.cross(out).norm(), in.dot(out));
    const double radius =
        0.5 * std::min(distance[i - 1], distance[i]) / std::max(std::tan(0.5 * turn), 1e-6);
    speed[i] = std::clamp(std::sqrt(a_max * radius), 0.1 * v_max, v_max);
  }
  for (std::size_t i = 1; i <= n; ++i) {
    speed[i] =
        std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * a_max * distance[i - 1]));
  }
  for (std::size_t i = n; i > 1; --i) {
    speed[i - 1] =
        std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + 2 * a_max * distance[i - 1]));
  }
  std::vector<double> durations(n);
  double yaw = start.yaw;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = std::abs(wrap_angle(waypoints[i].yaw - yaw));
    yaw = waypoints[i].yaw;
    durations[i] = std::max({params.min_duration_s, 1.5 * turn / params.max_yaw_rate,
                             trapezoid_s(distance[i], speed[i], speed[i + 1], v_max, a_max)});
  }
  return durations;
}

/// Chooses durations and solves.
Result<Trajectory> fit(Time start_time, const FlatReference& start,
                       const std::vector<Waypoint>& waypoints, int max_iterations,
                       const MinimumSnapPlanner::Params& params) {
  const double share = target_share(start, params);
  const double v_max = share * params.max_speed, a_max = share * params.max_acceleration;
  std::vector<double> durations = allocate(start, waypoints, v_max, a_max, params);
  // Shares of the time first: pieces that are nearer to a limit than others get more of it.
  std::vector<double> best = durations;
  double best_total = std::numeric_limits<double>::infinity();
  for (int round = 0; round < params.balance_rounds; ++round) {
    const Result<Trajectory> trajectory = minimum_snap(start_time, start, waypoints, durations);
    if (!trajectory) return trajectory;
    const std::vector<double> load = loads(*trajectory, v_max, a_max);
    const double worst = *std::max_element(load.begin(), load.end());
    const double total = worst * std::accumulate(durations.begin(), durations.end(), 0.0);
    if (total < best_total) {
      best_total = total;
      best = durations;
      for (double& duration : best) duration *= worst;
    }
    for (std::size_t i = 0; i < durations.size(); ++i) {
      durations[i] *= std::pow(std::clamp(load[i] / worst, 0.3, 1.0), kBalance);
    }
  }
  // Then all of it together. From rest the first round is the last: speed goes with 1 / time.
  durations = best;
  double worst = 0.0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Result<Trajectory> trajectory = minimum_snap(start_time, start, waypoints, durations);
    if (!trajectory) return trajectory;
    // The reserve may be used up where stretching does not win it back.
    const double slack = iteration < kRoundsForReserve ? 1.0 : 1.0 / share;
    const std::vector<double> load = loads(*trajectory, slack * v_max, slack * a_max);
    worst = *std::max_element(load.begin(), load.end());
    if (worst <= 1.0) return trajectory;
    for (double& duration : durations) duration *= std::clamp(worst + 1e-5, 1.0, 1.2);
  }
  return Error{
      fmt::format("after {} rounds of stretching the trajectory is still {:.3g} times too fast",
                  max_iterations, worst)};
}

}  // namespace

MinimumSnapPlanner::MinimumSnapPlanner() = default;
MinimumSnapPlanner::MinimumSnapPlanner(const Params& params) : params_(params) {}

Result<Trajectory> MinimumSnapPlanner::plan(Time start_time, const FlatReference& start,
                                            const std::vector<Waypoint>& waypoints) const {
  if (!(params_.max_speed > 0.0 && params_.max_acceleration > 0.0 && params_.max_yaw_rate > 0.0 &&
        params_.min_duration_s > 0.0)) {
    return Error{"the limits of the trajectory must be positive"};
  }
  // What the start has already cannot be planned away.
  if (start.velocity.norm() > params_.max_speed ||
      start.acceleration.norm() > params_.max_acceleration) {
    return Error{fmt::format(
        "the start has {:.3g} m/s and {:.3g} m/s^2, above the limits of {:.3g} and {:.3g}",
        start.velocity.norm(), start.acceleration.norm(), params_.max_speed,
        params_.max_acceleration)};
  }
  // Solving once checks all that is given.
  const std::vector<double> some(waypoints.size(), 1.0);
  if (const auto check = minimum_snap(start_time, start, waypoints, some); !check) return check;

  const bool at_rest = start.velocity.norm() < kRest && start.acceleration.norm() < kRest &&
                       start.jerk.norm() < kRest;
  const int rounds = at_rest ? params_.max_iterations : kRoundsInMotion;
  Result<Trajectory> result = fit(start_time, start, waypoints, rounds, params_);
  if (result || at_rest) return result;
  for (const TrajectorySegment& first : first_pieces(start, params_)) {
    if (max_derivative_norm(first, 1) > params_.max_speed ||
        max_derivative_norm(first, 2) > params_.max_acceleration) {
      continue;
    }
    FlatReference level;
    for (int axis = kX; axis <= kZ; ++axis) {
      level.position[axis] = derivative(first, axis, 1.0, 0);
      level.velocity[axis] = derivative(first, axis, 1.0, 1);
    }
    level.yaw = derivative(first, kYaw, 1.0, 0);
    level.yaw_rate = derivative(first, kYaw, 1.0, 1);
    result = fit(start_time, level, waypoints, params_.max_iterations, params_);
    if (!result) continue;
    std::vector<TrajectorySegment> segments{first};
    segments.insert(segments.end(), result->segments().begin(), result->segments().end());
    return Trajectory(start_time, std::move(segments));
  }
  return result;
}

}  // namespace swiftlet
