// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "planner/path/clearance_map.hpp"

namespace swiftlet {

/// Kinds of failure of planning. The sentence beside it has the numbers.
enum class PlanFailure {
  kNone,
  kBadInput,        ///< not finite, or no map at all
  kStartInContact,  ///< no free place within the escape distance
  kGoalInObstacle,  ///< the goal is nearer to an obstacle than radius + margin
  kGoalOutsideMap,  ///< too far away, or the unknown is not to be flown through
  kNoPath,          ///< start and goal are not connected by places with enough clearance
  kNoTrajectory,    ///< there is a path, but no trajectory along it within the limits
};

/// A polyline for the centre of the vehicle.
struct Path {
  std::vector<Eigen::Vector2d> points;  ///< [m], start and goal included
  double length = 0.0;                  ///< [m]
  double cost = 0.0;                    ///< integral of the cost per metre, without the escape
  double unknown_length = 0.0;          ///< of it through unknown space [m]
  /// The first point is nearer to an obstacle than allowed, the second is free.
  bool escapes = false;
};

struct PathResult {
  Path path;
  PlanFailure failure = PlanFailure::kNone;
  std::string reason;  ///< empty when it is ok
  bool ok() const { return failure == PlanFailure::kNone; }
};

/// Shortest path of a disc among obstacles, with respect to PathCost, on OMPL's FMT* (Janson,
/// Schmerling, Clark and Pavone, Fast marching tree, IJRR 34(7), 2015).
///
///  1. Whether there is a path is decided exactly, by flood fill over the cells with enough
///     clearance: a closed door is found in milliseconds, not by running out of samples. From and
///     to places beyond the map it is entered and left in a straight line.
///  2. FMT* connects samples drawn from the cells that the fill reached: some from around the
///  fill's
///     way, some from the ridge of the distance field in narrow passages, the rest from anywhere.
///  3. The cheaper of its path and the fill's, both shortened, is relaxed with respect to the cost.
///     Where samples do not connect, the fill's is taken: no seed makes planning fail.
///
/// Bounded by numbers of samples, never by time. The same map, points and seed give the same path,
/// bit for bit, whatever ran before.
class PathPlanner {
 public:
  struct Params {
    PathCost cost;
    int samples = 200;             ///< of FMT*
    double escape_distance = 0.4;  ///< a start in contact is moved at most so far [m]
    double border = 1.0;           ///< of unknown space around the grid, at least [m]
    double farthest = 300.0;       ///< goal from start, where one is outside of the map [m]
    int smoothing_rounds = 4;
  };

  PathPlanner();
  explicit PathPlanner(const Params& params);

  /// Path through a map as the planner sees it (see make_map).
  PathResult plan(const ClearanceMap& map, const Eigen::Vector2d& start,
                  const Eigen::Vector2d& goal, std::uint32_t seed) const;
  /// The same, from the grid.
  PathResult plan(const OccupancyGrid& grid, const Eigen::Vector2d& start,
                  const Eigen::Vector2d& goal, std::uint32_t seed) const;

  /// About the least that any path costs, for a third of the time of planning one: of the fill's
  /// way as much as eight directions can make it longer is taken off. Zero where `plan` would fail.
  double least_cost(const ClearanceMap& map, const Eigen::Vector2d& start,
                    const Eigen::Vector2d& goal) const;

  /// The map that `plan` works on, to be shared with the checks of a trajectory. It reaches to the
  /// start only where it is not open.
  Result<ClearanceMap> make_map(const OccupancyGrid& grid, const Eigen::Vector2d& start) const;
  /// Makes it that of another grid and start.
  Status update_map(ClearanceMap& map, const OccupancyGrid& grid,
                    const Eigen::Vector2d& start) const;

  const Params& params() const { return params_; }

 private:
  bool too_far(const ClearanceMap& map, const Eigen::Vector2d& start,
               const Eigen::Vector2d& goal) const;

  Params params_;
};

}  // namespace swiftlet
