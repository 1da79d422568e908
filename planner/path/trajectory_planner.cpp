// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/trajectory_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

// Waypoints nearer to each other only make the curve wriggle [m].
constexpr double kNearestWaypoints = 0.10;
// Path and curve are both looked at every half cell, at different places: what one misses between
// its places the other may see. In cells.
constexpr double kSamplingTolerance = 0.3;
// With YawPolicy::kAlongPath, the last stretch has no direction of its own [m].
constexpr double kFinalStretch = 1.0;

/// A polyline by its length.
class ByLength {
 public:
  explicit ByLength(const std::vector<Eigen::Vector2d>& points) : points_(points), at_{0.0} {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      at_.push_back(at_.back() + (points[i + 1] - points[i]).norm());
    }
  }
  double length() const { return at_.back(); }
  /// Of the corner `i`.
  double at(std::size_t i) const { return at_[i]; }
  Eigen::Vector2d point(double s) const {
    const std::size_t i = leg(s);
    const double leg_length = at_[i + 1] - at_[i];
    const double u = leg_length > 0 ? std::clamp((s - at_[i]) / leg_length, 0.0, 1.0) : 0.0;
    return points_[i] + u * (points_[i + 1] - points_[i]);
  }
  /// Direction of the leg that ends at or after s [rad].
  double direction(double s) const {
    const Eigen::Vector2d along = points_[leg(s) + 1] - points_[leg(s)];
    return std::atan2(along.y(), along.x());
  }

 private:
  std::size_t leg(double s) const {
    std::size_t i = 0;
    while (i + 2 < points_.size() && at_[i + 1] < s) ++i;
    return i;
  }
  const std::vector<Eigen::Vector2d>& points_;
  std::vector<double> at_;
};

/// Corners of the path that differ from the line of their neighbours by more than a tolerance
/// (Douglas and Peucker), as lengths along it.
void keep_corners(const std::vector<Eigen::Vector2d>& points, const ByLength& path,
                  std::size_t first, std::size_t last, double tolerance, std::set<double>& kept) {
  const Eigen::Vector2d along = points[last] - points[first];
  std::size_t farthest = first;
  double most = tolerance;
  for (std::size_t i = first + 1; i < last; ++i) {
    const Eigen::Vector2d to = points[i] - points[first];
    const double length = along.norm();
    const double distance =
        length > 1e-9 ? std::abs(along.x() * to.y() - along.y() * to.x()) / length : to.norm();
    if (distance > most) {
      most = distance;
      farthest = i;
    }
  }
  if (farthest == first) return;
  kept.insert(path.at(farthest));
  keep_corners(points, path, first, farthest, tolerance, kept);
  keep_corners(points, path, farthest, last, tolerance, kept);
}

/// Calls `visit(time_s, position, speed_m_s, step_s)` every half cell along the trajectory from
/// `from_s` after its start on, until it returns false.
template <class Visit>
void walk(const Trajectory& trajectory, double from_s, double resolution, Visit visit) {
  double begin_s = 0.0;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    const double T = segment.duration_s;
    if (begin_s + T >= from_s) {
      const double travelled = max_derivative_norm(segment, 1) * T;
      const int steps = std::max(2, 1 + static_cast<int>(travelled / (0.45 * resolution)));
      const double first = std::clamp((from_s - begin_s) / T, 0.0, 1.0);
      for (int i = 0; i <= steps; ++i) {
        const double s = first + (1.0 - first) * i / steps;
        const Eigen::Vector2d p(derivative(segment, kX, s, 0), derivative(segment, kY, s, 0));
        const double weight = (i == 0 || i == steps) ? 0.5 : 1.0;
        if (!visit(begin_s + s * T, p, weight * T * (1.0 - first) / steps, segment, s)) return;
      }
    }
    begin_s += T;
  }
}

bool is_finite(const FlatReference& state) {
  return state.position.allFinite() && state.velocity.allFinite() &&
         state.acceleration.allFinite() && state.jerk.allFinite() && std::isfinite(state.yaw) &&
         std::isfinite(state.yaw_rate) && std::isfinite(state.yaw_acceleration);
}

/// Rest to rest along every leg: exactly on the path, and slow.
Result<Trajectory> straight_legs(Time start_time, const FlatReference& start,
                                 const std::vector<Waypoint>& waypoints,
                                 const MinimumSnapPlanner& planner) {
  std::vector<TrajectorySegment> segments;
  FlatReference at;
  at.position = start.position;
  at.yaw = start.yaw;
  for (const Waypoint& waypoint : waypoints) {
    Result<Trajectory> leg = planner.plan(start_time, at, {waypoint});
    if (!leg) return leg;
    segments.push_back(leg->segments()[0]);
    at.position = waypoint.position;
    at.yaw = leg->final_reference().yaw;
  }
  return Trajectory(start_time, std::move(segments));
}

}  // namespace

std::optional<Time> first_conflict(const Trajectory& trajectory, Time from, const ClearanceMap& map,
                                   double clearance, double escape_distance) {
  if (trajectory.empty()) return std::nullopt;
  std::optional<Time> conflict;
  const double from_s = std::max(0.0, to_seconds(from - trajectory.start()));
  const Eigen::Vector2d beginning =
      trajectory.evaluate(std::max(from, trajectory.start())).position.head<2>();
  bool excused = map.clearance_at(beginning) < clearance;
  double reached = map.clearance_at(beginning);
  const auto visit = [&](double time_s, const Eigen::Vector2d& p, double, const TrajectorySegment&,
                         double) {
    const double here = map.clearance_at(p);
    if (here >= clearance) {
      excused = false;
      return true;
    }
    // Half a cell of tolerance: a noisy map rises in steps.
    if (excused && here >= reached - 0.5 * map.resolution() &&
        (p - beginning).norm() <= escape_distance) {
      reached = std::max(reached, here);
      return true;
    }
    conflict = trajectory.start() + from_seconds(time_s);
    return false;
  };
  if (from >= trajectory.end()) {
    // Hovering at the end.
    if (excused) conflict = from;
    return conflict;
  }
  walk(trajectory, from_s, map.resolution(), visit);
  return conflict;
}

double trajectory_cost(const Trajectory& trajectory, Time from, const ClearanceMap& map) {
  double cost = 0.0;
  const double from_s = std::max(0.0, to_seconds(from - trajectory.start()));
  walk(trajectory, from_s, map.resolution(),
       [&](double, const Eigen::Vector2d& p, double step_s, const TrajectorySegment& segment,
           double s) {
         const double speed =
             std::hypot(derivative(segment, kX, s, 1), derivative(segment, kY, s, 1));
         if (speed * step_s > 0) cost += map.density_at(p) * speed * step_s;
         return true;
       });
  return cost;
}

TrajectoryPlanner::TrajectoryPlanner() : TrajectoryPlanner(Params{}) {}
TrajectoryPlanner::TrajectoryPlanner(const Params& params)
    : params_(params), path_planner_(params.path), minimum_snap_(params.minimum_snap) {}

TrajectoryResult TrajectoryPlanner::plan(const OccupancyGrid& grid, Time start_time,
                                         const FlatReference& start, const FlightGoal& goal,
                                         std::uint32_t seed) const {
  TrajectoryResult result;
  const Eigen::Vector2d from = start.position.head<2>(), to = goal.position.head<2>();
  if (!from.allFinite() || !to.allFinite()) {
    result.failure = PlanFailure::kBadInput;
    result.reason = "start or goal of the trajectory is not finite";
    return result;
  }
  const Result<ClearanceMap> map = path_planner_.make_map(grid, from);
  if (!map) {
    result.failure = grid.empty() ? PlanFailure::kBadInput : PlanFailure::kGoalOutsideMap;
    result.reason = map.error().reason;
    return result;
  }
  return plan(*map, start_time, start, goal, seed);
}

TrajectoryResult TrajectoryPlanner::plan(const ClearanceMap& map, Time start_time,
                                         const FlatReference& start, const FlightGoal& goal,
                                         std::uint32_t seed) const {
  TrajectoryResult result;
  if (!goal.position.allFinite() || !std::isfinite(goal.yaw) || !is_finite(start)) {
    result.failure = PlanFailure::kBadInput;
    result.reason = "start or goal of the trajectory is not finite";
    return result;
  }
  PathResult path =
      path_planner_.plan(map, start.position.head<2>(), goal.position.head<2>(), seed);
  result.path = std::move(path.path);
  result.failure = path.failure;
  result.reason = std::move(path.reason);
  if (!result.ok()) return result;

  // Height grows with the way; so does yaw, or it follows the path.
  const std::vector<Eigen::Vector2d>& points = result.path.points;
  const ByLength along(points);
  const double length = along.length();
  const auto waypoint_at = [&](double s) {
    const double share = s >= length ? 1.0 : s / length;
    Waypoint waypoint;
    waypoint.position << along.point(s),
        start.position.z() + share * (goal.position.z() - start.position.z());
    waypoint.yaw = start.yaw;
    if (params_.yaw == YawPolicy::kGoal) {
      waypoint.yaw = wrap_angle(start.yaw + share * wrap_angle(goal.yaw - start.yaw));
    } else if (params_.yaw == YawPolicy::kAlongPath && length > kFinalStretch) {
      waypoint.yaw = along.direction(std::min(s, length - kFinalStretch));
    }
    return waypoint;
  };
  std::set<double> kept;
  keep_corners(points, along, 0, points.size() - 1, params_.waypoint_tolerance, kept);
  if (result.path.escapes) kept.insert(along.at(1));
  kept.erase(0.0);
  kept.insert(length);
  // Long legs in parts: time can be given to each, so that the speed can be level in between.
  for (auto at = kept.begin(); at != kept.end(); ++at) {
    const double before = at == kept.begin() ? 0.0 : *std::prev(at);
    const int parts = static_cast<int>(std::ceil((*at - before) / params_.waypoint_spacing));
    const double leg = *at - before;
    for (int k = 1; k < parts; ++k) kept.insert(before + leg * k / parts);
  }
  const auto waypoints_of = [&](const std::set<double>& lengths) {
    std::vector<Waypoint> waypoints;
    for (const double s : lengths) waypoints.push_back(waypoint_at(s));
    return waypoints;
  };

  const double clearance = map.cost().hard_clearance() - kSamplingTolerance * map.resolution();
  const double escape = params_.path.escape_distance + 2 * map.resolution();
  std::string problem;
  for (int round = 0; round <= params_.max_insertions; ++round) {
    Result<Trajectory> curve = minimum_snap_.plan(start_time, start, waypoints_of(kept));
    if (!curve) {
      problem = curve.error().reason;
      break;
    }
    const auto conflict = first_conflict(*curve, start_time, map, clearance, escape);
    if (!conflict) {
      result.trajectory = *std::move(curve);
      return result;
    }
    // More waypoints in every piece that comes too near.
    problem = fmt::format("the curve comes too near to an obstacle after {:.2f} s",
                          to_seconds(*conflict - start_time));
    std::set<double> added;
    double before = 0.0, begin_s = 0.0;
    // One in motion may have been given a first piece of its own.
    std::size_t i = curve->segments().size() - kept.size();
    for (std::size_t k = 0; k < i; ++k) begin_s += curve->segments()[k].duration_s;
    for (const double s : kept) {
      const TrajectorySegment& segment = curve->segments()[i++];
      const Trajectory piece(start_time + from_seconds(begin_s), {segment});
      const bool near =
          begin_s + segment.duration_s >= to_seconds(*conflict - start_time) &&
          first_conflict(piece, piece.start(), map, clearance, begin_s > 0 ? 0.0 : escape)
              .has_value();
      if (near && s - before > 2 * kNearestWaypoints) added.insert(0.5 * (before + s));
      begin_s += segment.duration_s;
      before = s;
    }
    if (added.empty()) break;
    kept.insert(added.begin(), added.end());
  }

  // Along the path itself, which keeps clear by construction.
  if (start.velocity.norm() <= params_.rest_speed &&
      start.acceleration.norm() <= params_.rest_acceleration) {
    std::set<double> all;
    for (std::size_t k = 1; k < points.size(); ++k) all.insert(along.at(k));
    all.erase(0.0);
    all.insert(length);
    Result<Trajectory> legs = straight_legs(start_time, start, waypoints_of(all), minimum_snap_);
    if (legs && !first_conflict(*legs, start_time, map, clearance, escape)) {
      result.trajectory = *std::move(legs);
      result.straight_legs = true;
      return result;
    }
    if (!legs) problem = legs.error().reason;
  }
  result.failure = PlanFailure::kNoTrajectory;
  result.reason = fmt::format("no trajectory along the path within the limits: {}", problem);
  return result;
}

}  // namespace swiftlet
