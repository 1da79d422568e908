// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/minimum_snap_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "planner/trajectory/durations.hpp"

namespace swiftlet {
namespace {

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
// Rounds of finding shares of least snap and the duration that they need.
constexpr int kLeastSnapRounds = 2;

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
      const double change = (1 - keep) * start.velocity.norm() + 0.3 * params.limits.max_speed;
      const double T = times * change / params.limits.max_acceleration;
      pieces.push_back(level_out(start, keep * motion.row(0), T));
    }
  }
  return pieces;
}

/// By how much every piece would have to be longer to keep the limits.
std::vector<double> loads(const Trajectory& trajectory, const TrajectoryLimits& limits) {
  std::vector<double> load;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    load.push_back(needed_stretch(segment, limits));
  }
  return load;
}

double largest(const std::vector<double>& load) {
  return *std::max_element(load.begin(), load.end());
}

double sum(const std::vector<double>& durations) {
  return std::accumulate(durations.begin(), durations.end(), 0.0);
}

void stretch(std::vector<double>& durations, double factor) {
  for (double& duration : durations) duration *= factor;
}

/// The share of the limits to aim at: what the reserve leaves, or what the start has already.
double target_share(const FlatReference& start, const MinimumSnapPlanner::Params& params) {
  const double started = usage(extrema(start), params.limits);
  return std::min(1.0, std::max(1.0 - std::clamp(params.reserve, 0.0, 0.9), 1.02 * started));
}

SpeedProfile speed_profile(const TrajectoryLimits& limits,
                           const MinimumSnapPlanner::Params& params) {
  return {limits.max_speed, limits.max_acceleration,
          std::min(params.nominal_yaw_rate, limits.max_yaw_rate), params.min_duration_s};
}

/// Moves time to the pieces that are nearer to a limit than others, in a few rounds.
Result<std::vector<double>> balanced(const FlatReference& start,
                                     const std::vector<Waypoint>& waypoints,
                                     std::vector<double> durations, const TrajectoryLimits& limits,
                                     int rounds) {
  std::vector<double> best = durations;
  double best_total = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const Result<Trajectory> trajectory = minimum_snap(Time{}, start, waypoints, durations);
    if (!trajectory) return trajectory.error();
    const std::vector<double> load = loads(*trajectory, limits);
    const double worst = largest(load);
    const double total = worst * sum(durations);
    if (total < best_total) {
      best_total = total;
      best = durations;
      stretch(best, worst);
    }
    for (std::size_t i = 0; i < durations.size(); ++i) {
      durations[i] *= std::pow(std::clamp(load[i] / worst, 0.3, 1.0), kBalance);
    }
  }
  return best;
}

/// Moves time to where it lowers the cost most, and stretches all of it to about what the limits
/// need. How long that is changes the shares of a trajectory that does not begin and end at rest.
Result<std::vector<double>> of_least_snap(const FlatReference& start,
                                          const std::vector<Waypoint>& waypoints,
                                          std::vector<double> durations,
                                          const TrajectoryLimits& limits) {
  for (int round = 0; round < kLeastSnapRounds; ++round) {
    const auto shares = least_snap_durations(start, waypoints, sum(durations));
    if (!shares) return shares;
    durations = *shares;
    const Result<Trajectory> trajectory = minimum_snap(Time{}, start, waypoints, durations);
    if (!trajectory) return trajectory.error();
    stretch(durations, largest(loads(*trajectory, limits)));
  }
  return durations;
}

/// Chooses durations and solves.
Result<Trajectory> fit(Time start_time, const FlatReference& start,
                       const std::vector<Waypoint>& waypoints, int max_iterations,
                       const MinimumSnapPlanner::Params& params) {
  const double share = target_share(start, params);
  const TrajectoryLimits aim = share_of(params.limits, share);
  std::vector<double> durations = trapezoid_durations(start, waypoints, speed_profile(aim, params));
  // Shares of the time first.
  const auto shared = params.timing == Timing::kLeastSnap
                          ? of_least_snap(start, waypoints, durations, aim)
                          : balanced(start, waypoints, durations, aim, params.balance_rounds);
  if (!shared) return shared.error();
  durations = *shared;
  // Then all of it together. From rest the first round is the last where speed and acceleration
  // are all that is limited: speed goes with 1 / time.
  double worst = 0.0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Result<Trajectory> trajectory = minimum_snap(start_time, start, waypoints, durations);
    if (!trajectory) return trajectory;
    // The reserve may be used up where stretching does not win it back.
    worst = largest(loads(*trajectory, iteration < kRoundsForReserve ? aim : params.limits));
    if (worst <= 1.0) return trajectory;
    stretch(durations, std::clamp(worst + 1e-5, 1.0, 1.2));
  }
  return Error{
      fmt::format("after {} rounds of stretching the trajectory is still {:.3g} times too fast",
                  max_iterations, worst)};
}

/// Whether what is given can be flown at all.
Status check(const FlatReference& start, const std::vector<Waypoint>& waypoints,
             const MinimumSnapPlanner::Params& params) {
  if (const Status sound = check(params.limits); !sound) return sound;
  if (!(params.nominal_yaw_rate > 0.0 && params.min_duration_s > 0.0)) {
    return Error{"the yaw rate and the least duration of the trajectory must be positive"};
  }
  // Solving once checks all that is given.
  const std::vector<double> some(waypoints.size(), 1.0);
  if (const auto solved = minimum_snap(Time{}, start, waypoints, some); !solved) {
    return solved.error();
  }
  // What the start has already cannot be planned away, nor what a waypoint prescribes.
  if (const Status kept = within(extrema(start), params.limits); !kept) {
    return Error{fmt::format("at the start {}", kept.error().reason)};
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    FlatReference prescribed;
    prescribed.velocity = waypoints[i].velocity.value_or(Eigen::Vector3d::Zero());
    prescribed.acceleration = waypoints[i].acceleration.value_or(Eigen::Vector3d::Zero());
    if (const Status kept = within(extrema(prescribed), params.limits); !kept) {
      return Error{fmt::format("at waypoint {} {}", i + 1, kept.error().reason)};
    }
  }
  return {};
}

}  // namespace

MinimumSnapPlanner::MinimumSnapPlanner() = default;
MinimumSnapPlanner::MinimumSnapPlanner(const Params& params) : params_(params) {}

Result<Trajectory> MinimumSnapPlanner::plan(Time start_time, const FlatReference& start,
                                            const std::vector<Waypoint>& waypoints) const {
  if (const Status usable = check(start, waypoints, params_); !usable) return usable.error();
  const bool at_rest = start.velocity.norm() < kRest && start.acceleration.norm() < kRest &&
                       start.jerk.norm() < kRest;
  const int rounds = at_rest ? params_.max_iterations : kRoundsInMotion;
  Result<Trajectory> result = fit(start_time, start, waypoints, rounds, params_);
  if (result || at_rest) return result;
  for (const TrajectorySegment& first : first_pieces(start, params_)) {
    if (!within(first, params_.limits)) continue;
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

Result<Trajectory> MinimumSnapPlanner::plan_for(Time start_time, const FlatReference& start,
                                                const std::vector<Waypoint>& waypoints,
                                                double duration_s) const {
  if (const Status usable = check(start, waypoints, params_); !usable) return usable.error();
  if (!(duration_s > 0.0)) return Error{"the duration of the trajectory must be positive"};
  const auto durations = least_snap_durations(start, waypoints, duration_s);
  if (!durations) return durations.error();
  Result<Trajectory> trajectory = minimum_snap(start_time, start, waypoints, *durations);
  if (!trajectory) return trajectory;
  const Status kept = within(extrema(*trajectory), params_.limits);
  if (kept) return trajectory;
  Params longer = params_;
  longer.timing = Timing::kLeastSnap;
  longer.reserve = 0.0;
  const auto possible = MinimumSnapPlanner(longer).plan(start_time, start, waypoints);
  return Error{fmt::format(
      "in {:.4g} s {}; {}", duration_s, kept.error().reason,
      possible ? fmt::format("it would have to take {:.4g} s", to_seconds(possible->duration()))
               : "no other duration helps: " + possible.error().reason)};
}

}  // namespace swiftlet
