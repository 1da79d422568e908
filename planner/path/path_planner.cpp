// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/path_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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

/// The same; of a point outside of an open map, the cell that would be there.
std::optional<Cell> anchor_anywhere(const ClearanceMap& map, const Eigen::Vector2d& point) {
  if (!map.open() || map.contains(point)) return anchor(map, point);
  const Eigen::Vector2d cells = (point - map.origin()) / map.resolution();
  return Cell{static_cast<int>(std::floor(cells.x())), static_cast<int>(std::floor(cells.y()))};
}

/// Of the line between two points of which one is outside, which no fill knows; infinite otherwise.
double cost_across(const ClearanceMap& map, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return map.contains(a) && map.contains(b) ? std::numeric_limits<double>::infinity()
                                            : map.segment_cost(a, b);
}

/// The way with start and goal at its ends where these are outside of the map.
Polyline with_ends(const ClearanceMap& map, Polyline way, const Eigen::Vector2d& start,
                   const Eigen::Vector2d& goal) {
  if (!map.contains(start)) way.insert(way.begin(), start);
  if (!map.contains(goal)) way.push_back(goal);
  return way;
}

Polyline centers(const ClearanceMap& map, const std::vector<Cell>& cells) {
  Polyline line;
  for (const Cell cell : cells) line.push_back(map.center_of(cell));
  return line;
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

Result<ClearanceMap> PathPlanner::make_map(const OccupancyGrid& grid,
                                           const Eigen::Vector2d& start) const {
  ClearanceMap map(params_.cost);
  if (Status status = update_map(map, grid, start); !status) return status.error();
  return map;
}

Status PathPlanner::update_map(ClearanceMap& map, const OccupancyGrid& grid,
                               const Eigen::Vector2d& start) const {
  if (!params_.cost.unknown_is_free) return map.update(grid, {start}, params_.border);
  // Two cells more than what costs, as the map knows it.
  const double felt = params_.cost.free_clearance() + 2.0 * grid.resolution();
  return map.update(grid, {}, std::max(params_.border, felt));
}

double PathPlanner::least_cost(const ClearanceMap& map, const Eigen::Vector2d& start,
                               const Eigen::Vector2d& goal) const {
  if (map.empty() || too_far(map, start, goal)) return 0.0;
  const std::optional<Cell> from = anchor_anywhere(map, start), to = anchor_anywhere(map, goal);
  if (!from || !to) return 0.0;
  const std::vector<Cell> cells = flood_fill(map, *from, *to).to_goal;
  const double straight = cost_across(map, start, goal);
  if (cells.empty()) return std::isfinite(straight) ? straight : 0.0;
  const Polyline way = with_ends(map, centers(map, cells), start, goal);
  return std::min(straight, kEightDirections * polyline_cost(map, way));
}

/// Whether the goal is farther than is planned beyond the map.
bool PathPlanner::too_far(const ClearanceMap& map, const Eigen::Vector2d& start,
                          const Eigen::Vector2d& goal) const {
  return (!map.contains(start) || !map.contains(goal)) &&
         !((goal - start).norm() <= params_.farthest);
}

PathResult PathPlanner::plan(const OccupancyGrid& grid, const Eigen::Vector2d& start,
                             const Eigen::Vector2d& goal, std::uint32_t seed) const {
  if (!start.allFinite() || !goal.allFinite()) {
    return failed(PlanFailure::kBadInput, "start or goal of the path is not finite");
  }
  const Result<ClearanceMap> map = make_map(grid, start);
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
  if ((!map.contains(goal) && !map.open()) ||
      (!map.cost().unknown_is_free && map.unknown_at(goal))) {
    return failed(
        PlanFailure::kGoalOutsideMap,
        fmt::format("the goal ({:.2f}, {:.2f}) is outside of the map", goal.x(), goal.y()));
  }
  if (too_far(map, start, goal)) {
    return failed(PlanFailure::kGoalOutsideMap,
                  fmt::format("the goal ({:.2f}, {:.2f}) is {:.0f} m away, and no way beyond the "
                              "map is longer than {:.0f} m",
                              goal.x(), goal.y(), (goal - start).norm(), params_.farthest));
  }
  const std::optional<Cell> goal_cell = anchor_anywhere(map, goal);
  if (!goal_cell) {
    return failed(PlanFailure::kGoalInObstacle,
                  fmt::format("the goal ({:.2f}, {:.2f}) is {:.2f} m from an obstacle, the vehicle "
                              "needs {:.2f} m",
                              goal.x(), goal.y(), std::max(0.0, map.clearance_at(goal)), hard));
  }

  // Out of the reach of obstacles, where the start is too near to one.
  PathResult result;
  Eigen::Vector2d free_start = start;
  std::optional<Cell> start_cell = anchor_anywhere(map, start);
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
  const bool straight = std::isfinite(cost_across(map, free_start, goal));
  if (fill.to_goal.empty() && !straight) {
    return failed(PlanFailure::kNoPath,
                  fmt::format("no path from ({:.2f}, {:.2f}) to ({:.2f}, {:.2f}) with {:.2f} m "
                              "clearance",
                              start.x(), start.y(), goal.x(), goal.y(), hard));
  }

  // 2. FMT*, and 3. the cheapest, smoothed.
  Polyline line{free_start, goal};
  const auto consider = [&](const Polyline& candidate) {
    if (polyline_cost(map, candidate) < polyline_cost(map, line)) line = candidate;
  };
  if (!fill.to_goal.empty()) {
    Polyline filled = centers(map, fill.to_goal);
    const Eigen::Vector2d first = filled.front(), last = filled.back();
    filled.insert(filled.begin(), free_start);
    filled.push_back(goal);
    filled = shortcut(map, thin(map, filled, kSpacing), kPricePerPoint);
    if (!straight) line = filled;
    consider(filled);
    FastMarchingTreeParams tree;
    tree.samples = params_.samples;
    const Polyline rough =
        fast_marching_tree(map, fill, map.contains(free_start) ? free_start : first,
                           map.contains(goal) ? goal : last, tree, seed);
    if (rough.size() >= 2) {
      consider(shortcut(map, with_ends(map, rough, free_start, goal), kPricePerPoint));
    }
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
