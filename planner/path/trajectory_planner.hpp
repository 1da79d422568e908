// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "planner/path/path_planner.hpp"
#include "planner/trajectory/minimum_snap_planner.hpp"

namespace swiftlet {

/// Where to fly to.
struct FlightGoal {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< [rad], see YawPolicy
};

enum class YawPolicy {
  kHold,       ///< keep the yaw of the start
  kAlongPath,  ///< look where it flies to, but for the last metre keep the direction
  kGoal,       ///< turn to the yaw of the goal on the way
};

struct TrajectoryResult {
  Trajectory trajectory;
  Path path;
  PlanFailure failure = PlanFailure::kNone;
  std::string reason;          ///< empty when it is ok
  bool straight_legs = false;  ///< the slow fallback: from rest to rest along the path
  bool ok() const { return failure == PlanFailure::kNone; }
};

/// Path, then minimum-snap trajectory along it that keeps the hard clearance all the way: where the
/// curve leaves the path too far, waypoints of the path are added (Richter, Bry and Roy 2013,
/// section 3.4), a bounded number of times. What is left then is flown in straight legs from rest
/// to rest, which needs a start at rest.
class TrajectoryPlanner {
 public:
  struct Params {
    PathPlanner::Params path;
    MinimumSnapPlanner::Params minimum_snap;
    YawPolicy yaw = YawPolicy::kHold;
    int max_insertions = 8;  ///< rounds of added waypoints
    double waypoint_tolerance =
        0.05;                         ///< path points nearer to the line of others are left out [m]
    double waypoint_spacing = 1.2;    ///< longer legs get waypoints in between [m]
    double rest_speed = 0.02;         ///< slower counts as at rest [m/s]
    double rest_acceleration = 0.10;  ///< [m/s^2]
  };

  TrajectoryPlanner();
  explicit TrajectoryPlanner(const Params& params);

  /// Trajectory from the flat state `start` at `start_time` to rest at the goal.
  TrajectoryResult plan(const ClearanceMap& map, Time start_time, const FlatReference& start,
                        const FlightGoal& goal, std::uint32_t seed) const;
  TrajectoryResult plan(const OccupancyGrid& grid, Time start_time, const FlatReference& start,
                        const FlightGoal& goal, std::uint32_t seed) const;

  const PathPlanner& path_planner() const { return path_planner_; }
  const Params& params() const { return params_; }

 private:
  Params params_;
  PathPlanner path_planner_;
  MinimumSnapPlanner minimum_snap_;
};

/// The first moment from `from` on when the trajectory is nearer to an obstacle than `clearance`
/// [m], or nothing. Looks at every half cell. Where it is too near already at `from`, that is
/// excused while it gets no nearer, for the first `escape_distance` [m].
std::optional<Time> first_conflict(const Trajectory& trajectory, Time from, const ClearanceMap& map,
                                   double clearance, double escape_distance);

/// Integral of the map's cost per metre along the rest of a trajectory, from `from` on; infinite
/// where it is nearer to an obstacle than the hard clearance.
double trajectory_cost(const Trajectory& trajectory, Time from, const ClearanceMap& map);

}  // namespace swiftlet
