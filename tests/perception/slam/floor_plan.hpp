// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "estimation/geometry/pose2.hpp"
#include "perception/laser_scan.hpp"

namespace swiftlet::test {

/// Walls in the plane, and what a scanner among them sees.
class FloorPlan {
 public:
  void add_wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    walls_.push_back({from, to});
  }
  void add_box(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
    const Eigen::Vector2d right(upper.x(), lower.y()), left(lower.x(), upper.y());
    add_wall(lower, right);
    add_wall(right, upper);
    add_wall(upper, left);
    add_wall(left, lower);
  }

  /// [m]; infinite where the ray meets nothing.
  double range(const Eigen::Vector2d& from, double angle) const {
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls_) {
      const Eigen::Vector2d along = wall.to - wall.from, to_wall = wall.from - from;
      const double cross = direction.x() * along.y() - direction.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const double t = (to_wall.x() * along.y() - to_wall.y() * along.x()) / cross;
      const double s = (to_wall.x() * direction.y() - to_wall.y() * direction.x()) / cross;
      if (t > 0.0 && s >= 0.0 && s <= 1.0) nearest = std::min(nearest, t);
    }
    return nearest;
  }

  /// A turn of `beams` over `field_of_view` [rad], each with normal noise [m].
  LaserScan scan(const Pose2& pose, int beams, double field_of_view, double noise,
                 std::mt19937& random) const {
    LaserScan scan;
    scan.angle_min = -0.5 * field_of_view;
    scan.angle_increment = field_of_view / beams;
    scan.range_min = 0.05;
    scan.range_max = 30.0;
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int i = 0; i < beams; ++i) {
      const double angle = pose.yaw + scan.angle_min + i * scan.angle_increment;
      scan.ranges.push_back(
          static_cast<float>(range(pose.position, angle) + noise * normal(random)));
    }
    return scan;
  }

 private:
  struct Wall {
    Eigen::Vector2d from, to;
  };
  std::vector<Wall> walls_;
};

/// 24 m by 14 m with a corridor all around a block, and things along it that are nowhere alike.
inline FloorPlan office_floor() {
  FloorPlan plan;
  plan.add_box({0, 0}, {24, 14});
  plan.add_box({3, 3}, {21, 11});
  plan.add_box({4.0, 0.0}, {5.1, 0.6});
  plan.add_box({9.3, 2.4}, {10.0, 3.0});
  plan.add_box({13.6, 0.0}, {13.9, 0.9});
  plan.add_box({17.7, 0.0}, {19.5, 0.3});
  plan.add_box({23.2, 4.1}, {24.0, 5.6});
  plan.add_box({21.0, 7.7}, {21.5, 8.1});
  plan.add_box({23.6, 10.0}, {24.0, 10.5});
  plan.add_box({17.0, 13.1}, {17.4, 14.0});
  plan.add_box({11.0, 13.5}, {13.4, 14.0});
  plan.add_box({7.9, 11.0}, {8.6, 11.8});
  plan.add_box({0.0, 8.8}, {0.7, 9.1});
  plan.add_box({2.5, 5.5}, {3.0, 6.9});
  return plan;
}

}  // namespace swiftlet::test
