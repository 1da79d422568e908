// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {

inline constexpr double kBlockRate_hz = 20.0;
inline constexpr int kBlockBeams = 1000;

struct BlockStep {
  Pose2 odometry;
  LaserScan scan;
};

/// Around the block of the office floor and on along its first side, looking ahead, with odometry
/// that drifts.
inline std::vector<BlockStep> drive_around_the_block(double speed = 0.8) {
  const FloorPlan plan = office_floor();
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  const std::vector<Eigen::Vector2d> corners{{1.5, 1.5}, {22.3, 1.6}, {22.2, 12.4}, {1.7, 12.3}};
  const double ahead = speed / kBlockRate_hz, turn = 1.0 / kBlockRate_hz;
  std::vector<BlockStep> steps;
  Pose2 pose{corners[0], 0.0}, odometry;
  const auto go = [&](const Pose2& next) {
    const Pose2 moved = pose.inverse() * next;
    const Eigen::Vector2d slip = 0.03 * moved.position.norm() * Eigen::Vector2d(normal(random), 0);
    odometry = odometry * Pose2{moved.position + slip, moved.yaw * (1.0 + 0.02 * normal(random))};
    pose = next;
    steps.push_back({odometry, plan.scan(pose, kBlockBeams, 1.5 * M_PI, 0.01, random)});
  };
  for (std::size_t leg = 0; leg < 5; ++leg) {
    const Eigen::Vector2d to = corners[(leg + 1) % 4], way = to - pose.position;
    const double heading = std::atan2(way.y(), way.x());
    while (std::abs(wrap_angle(heading - pose.yaw)) > turn) {
      go({pose.position, wrap_angle(pose.yaw + turn)});
    }
    const Eigen::Vector2d from = pose.position;
    for (double d = ahead; d < way.norm(); d += ahead) {
      go({from + way.normalized() * d, heading});
    }
  }
  return steps;
}

}  // namespace swiftlet::test
