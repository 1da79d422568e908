// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/path_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/path/fast_marching_tree.hpp"
#include "planner/path/flood_fill.hpp"
#include "planner/path/path_smoothing.hpp"

namespace swiftlet {
namespace {

// Price of a corner of the path [m]: decides between equals.
constexpr double kPricePerPoint = 0.01;
constexpr double kEightDirections = 0.924;  // cos(22.5 deg): a straight line over a way of steps
constexpr double kSpacing = 0.30;           // of the points that relaxation moves [m]

PathResult failed(PlanFailure failure, std::string reason) {
  PathResult result;
  result.failure = failure;
  result.reason = std::move(reason);
  return result;
}

/// Of the four centres around a point, the nearest free one that can be flown to in a line.
std::optional<Cell> anchor(const ClearanceMap& map, const Eigen::Vector2d& point) {
  const Eigen::Vector2d corner = (point - map.origin()) / map.resolution();
  const int x0 = static_cast<int>(std::floor(corner.x() - 0.5));
  const int y0 = static_cast<int>(std::floor(corner.y() - 0.5));
  std::optional<Cell> best;
  double nearest = 0.0;
  for (int y = y0; y <= y0 + 1; ++y) {
    for (int x = x0; x <= x0 + 1; ++x) {
      const Cell cell{x, y};
      if (!map.contains(cell) || !map.is_free(cell)) continue;
      const Eigen::Vector2d center = map.center_of(cell);
      const double distance = (center - point).norm();
      if (best && distance >= nearest) continue;
      if (!std::isfinite(map.segment_cost(point, center))) continue;
      best = cell;
      nearest = distance;
    }
  }
  return best;
}

/// The nearest free cell within a distance, where the line to it never gets nearer to an obstacle
/// than its beginning is.
std::optional<Cell> nearest_free(const ClearanceMap& map, const Eigen::Vector2d& point,
                                 double max_distance) {
  const Cell center = map.cell_of(point);
  const int reach = static_cast<int>(std::ceil(max_distance / map.resolution()));
  const double contact = map.clearance_at(point) - map.resolution();
  std::optional<Cell> best;
  double nearest = max_distance;
  for (int y = center.y - reach; y <= center.y + reach; ++y) {
    for (int x = center.x - reach; x <= center.x + reach; ++x) {
      const Cell cell{x, y};
      if (!map.contains(cell) || !map.is_free(cell)) continue;
      const Eigen::Vector2d target = map.center_of(cell);
      const double distance = (target - point).norm();
      if (!(distance < nearest)) continue;
      bool open = true;
      const int steps = 1 + static_cast<int>(2.0 * distance / map.resolution());
      for (int i = 0; i <= steps && open; ++i) {
        const Eigen::Vector2d p = point + (target - point) * (static_cast<double>(i) / steps);
        open = map.clearance_at(p) >= contact;
      }
      if (!open) continue;
      best = cell;
      nearest = distance;
    }
  }
  return best;
}

double unknown_length(const ClearanceMap& map, const Polyline& line) {
  double length = 0.0;
  const Polyline fine = resample(line, 0.5 * map.resolution());
  for (std::size_t i = 0; i + 1 < fine.size(); ++i) {
    if (map.unknown_at(0.5 * (fine[i] + fine[i + 1]))) length += (fine[i + 1] - fine[i]).norm();
  }
  return length;
}

Polyline smooth(const ClearanceMap& map, const Polyline& rough, int rounds) {
  Polyline line = resample(rough, kSpacing);
  relax(map, line, rounds);
  return shortcut(map, line, kPricePerPoint);
}

}  // namespace

PathPlanner::PathPlanner() = default;
PathPlanner::PathPlanner(const Params& params) : params_(params) {}

Result<ClearanceMap> PathPlanner::make_map(const OccupancyGrid& grid, const Eigen::Vector2d& start,
                                           const Eigen::Vector2d& goal) const {
  return ClearanceMap::make(grid, params_.cost, {start, goal}, params_.border);
}

double PathPlanner::least_cost(const ClearanceMap& map, const Eigen::Vector2d& start,
                               const Eigen::Vector2d& goal) const {
  if (map.empty() || !map.contains(start) || !map.contains(goal)) return 0.0;
  const std::optional<Cell> from = anchor(map, start), to = anchor(map, goal);
  if (!from || !to) return 0.0;
  Polyline way;
  for (const Cell cell : flood_fill(map, *from, *to).to_goal) way.push_back(map.center_of(cell));
  return kEightDirections * polyline_cost(map, way);
}

PathResult PathPlanner::plan(const OccupancyGrid& grid, const Eigen::Vector2d& start,
                             const Eigen::Vector2d& goal, std::uint32_t seed) const {
  if (!start.allFinite() || !goal.allFinite()) {
    return failed(PlanFailure::kBadInput, "start or goal of the path is not finite");
  }
  const Result<ClearanceMap> map = make_map(grid, start, goal);
  if (!map) {
    return failed(grid.empty() ? PlanFailure::kBadInput : PlanFailure::kGoalOutsideMap,
                  map.error().reason);
  }
  return plan(*map, start, goal, seed);
}

PathResult PathPlanner::plan(const ClearanceMap& map, const Eigen::Vector2d& start,
                             const Eigen::Vector2d& goal, std::uint32_t seed) const {
  if (!start.allFinite() || !goal.allFinite()) {
    return failed(PlanFailure::kBadInput, "start or goal of the path is not finite");
  }
  if (map.empty()) return failed(PlanFailure::kBadInput, "there is no map to plan in yet");
  const double hard = map.cost().hard_clearance();
  if (!map.contains(goal) || (!map.cost().unknown_is_free && map.unknown_at(goal))) {
    return failed(
        PlanFailure::kGoalOutsideMap,
        fmt::format("the goal ({:.2f}, {:.2f}) is outside of the map", goal.x(), goal.y()));
  }
  const std::optional<Cell> goal_cell = anchor(map, goal);
  if (!goal_cell) {
    return failed(PlanFailure::kGoalInObstacle,
                  fmt::format("the goal ({:.2f}, {:.2f}) is {:.2f} m from an obstacle, the vehicle "
                              "needs {:.2f} m",
                              goal.x(), goal.y(), std::max(0.0, map.clearance_at(goal)), hard));
  }

  // Out of the reach of obstacles, where the start is too near to one.
  PathResult result;
  Eigen::Vector2d free_start = start;
  std::optional<Cell> start_cell = anchor(map, start);
  if (!start_cell) {
    start_cell = nearest_free(map, start, params_.escape_distance);
    if (!start_cell) {
      return failed(
          PlanFailure::kStartInContact,
          fmt::format("the start ({:.2f}, {:.2f}) is {:.2f} m from an obstacle, the vehicle needs "
                      "{:.2f} m, and no free place is within {:.2f} m",
                      start.x(), start.y(), std::max(0.0, map.clearance_at(start)), hard,
                      params_.escape_distance));
    }
    free_start = map.center_of(*start_cell);
    result.path.escapes = true;
  }

  // 1. Is there a way at all?
  const FloodFill fill = flood_fill(map, *start_cell, *goal_cell);
  if (fill.to_goal.empty()) {
    return failed(PlanFailure::kNoPath,
                  fmt::format("no path from ({:.2f}, {:.2f}) to ({:.2f}, {:.2f}) with {:.2f} m "
                              "clearance",
                              start.x(), start.y(), goal.x(), goal.y(), hard));
  }
  Polyline filled{free_start};
  for (const Cell cell : fill.to_goal) filled.push_back(map.center_of(cell));
  filled.push_back(goal);

  // 2. FMT*, and 3. the cheaper of the two, smoothed.
  Polyline line = shortcut(map, thin(map, filled, kSpacing), kPricePerPoint);
  FastMarchingTreeParams tree;
  tree.samples = params_.samples;
  const Polyline rough = fast_marching_tree(map, fill, free_start, goal, tree, seed);
  if (rough.size() >= 2) {
    Polyline candidate = shortcut(map, rough, kPricePerPoint);
    if (polyline_cost(map, candidate) < polyline_cost(map, line)) line = std::move(candidate);
  }
  line = smooth(map, line, params_.smoothing_rounds);

  Path& path = result.path;
  path.cost = polyline_cost(map, line);
  if (path.escapes) line.insert(line.begin(), start);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) path.length += (line[i + 1] - line[i]).norm();
  path.unknown_length = unknown_length(map, line);
  path.points = std::move(line);
  return result;
}

}  // namespace swiftlet
