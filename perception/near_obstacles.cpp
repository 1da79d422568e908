// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/near_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace swiftlet {

NearObstacles::NearObstacles(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
  points_.erase(std::remove_if(points_.begin(), points_.end(),
                               [](const Eigen::Vector2d& p) { return !p.allFinite(); }),
                points_.end());
}

std::optional<Eigen::Vector2d> NearObstacles::nearest(const Eigen::Vector2d& place) const {
  const auto found = std::min_element(
      points_.begin(), points_.end(), [&place](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return (a - place).squaredNorm() < (b - place).squaredNorm();
      });
  if (found == points_.end()) return std::nullopt;
  return *found;
}

double NearObstacles::clearance(const Eigen::Vector2d& place) const {
  const auto point = nearest(place);
  return point ? (*point - place).norm() : std::numeric_limits<double>::infinity();
}

double NearObstacles::free_way(const Eigen::Vector2d& place, const Eigen::Vector2d& direction,
                               double radius) const {
  double way = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : points_) {
    const Eigen::Vector2d to_point = point - place;
    const double along = to_point.dot(direction);
    if (along <= 0.0) continue;
    const double half_chord_squared = radius * radius - to_point.squaredNorm() + along * along;
    if (half_chord_squared <= 0.0) continue;
    way = std::min(way, along - std::sqrt(half_chord_squared));
  }
  return std::max(way, 0.0);
}

}  // namespace swiftlet
