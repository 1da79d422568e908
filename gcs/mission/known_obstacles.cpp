// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/known_obstacles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace swiftlet {
namespace {

/// The part of the way from `from` to `to` within a box, as shares of it; first > second where
/// there is none (Liang and Barsky 1984).
std::pair<double, double> clip(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0.0) {
      if (from[axis] < lower[axis] || from[axis] > upper[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (lower[axis] - from[axis]) / way, b = (upper[axis] - from[axis]) / way;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return {first, last};
}

}  // namespace

KnownObstacles::KnownObstacles(const OccupancyGrid& map, double clearance)
    : map_(map), clearance_(clearance), field_(map, {false, clearance + 1.0}) {}

bool KnownObstacles::covers(double height) const {
  return height >= map_.params().min_height && height <= map_.params().max_height;
}

bool KnownObstacles::knows(const Eigen::Vector2d& place) const {
  return map_.state(map_.cell_of(place)) != CellState::kUnknown;
}

/// From the place to the nearest edge of an obstacle's cell, within half a cell [m].
double KnownObstacles::free_at(const Eigen::Vector2d& place) const {
  return std::max(0.0, field_.distance_at(place) - 0.5 * map_.resolution());
}

std::string KnownObstacles::problem_at(const Eigen::Vector2d& place) const {
  if (!map_.contains(map_.cell_of(place))) return "";
  if (map_.state(map_.cell_of(place)) == CellState::kOccupied) return "is inside an obstacle";
  const double free = free_at(place);
  if (free >= clearance_) return "";
  return fmt::format("is {:.2f} m from an obstacle, and the vehicle needs {:.2f} m", free,
                     clearance_);
}

std::string KnownObstacles::problem_on(const Eigen::Vector2d& from,
                                       const Eigen::Vector2d& to) const {
  if (map_.empty()) return "";
  const Eigen::Vector2d lower = map_.origin();
  const Eigen::Vector2d upper =
      lower + map_.resolution() * Eigen::Vector2d(map_.width(), map_.height());
  const auto [first, last] = clip(from, to, lower, upper);
  if (first > last) return "";
  const double way = (last - first) * (to - from).norm();
  const int steps = static_cast<int>(std::ceil(2.0 * way / map_.resolution()));
  for (int i = 0; i <= steps; ++i) {
    const double share =
        first + (last - first) * (steps > 0 ? static_cast<double>(i) / steps : 0.0);
    const Eigen::Vector2d place = from + share * (to - from);
    const std::string problem = problem_at(place);
    if (problem.empty()) continue;
    return fmt::format("at x {:.2f}, y {:.2f}, {:.1f} m on its way, it {}", place.x(), place.y(),
                       share * (to - from).norm(), problem);
  }
  return "";
}

}  // namespace swiftlet
