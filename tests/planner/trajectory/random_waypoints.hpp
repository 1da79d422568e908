// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Starts and waypoints for tests of trajectories.
#pragma once

#include <random>
#include <vector>

#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet::test {

inline FlatReference at_rest(const Eigen::Vector3d& position, double yaw = 0.0) {
  FlatReference start;
  start.position = position;
  start.yaw = yaw;
  return start;
}

inline FlatReference moving(std::mt19937& random, double speed, double acceleration) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(u(random), u(random), u(random)); };
  FlatReference start;
  start.position = vector();
  start.velocity = speed * vector() / 1.8;
  start.acceleration = acceleration * vector() / 1.8;
  start.jerk = vector();
  start.yaw = 3 * u(random);
  start.yaw_rate = 0.5 * u(random);
  return start;
}

inline std::vector<Waypoint> random_waypoints(std::mt19937& random, int n, double size) {
  std::uniform_real_distribution<double> u(-size, size),
      yaw(-3.14159265358979323846, 3.14159265358979323846);
  std::vector<Waypoint> waypoints(static_cast<std::size_t>(n));
  for (Waypoint& w : waypoints) {
    w.position = {u(random), u(random), 0.3 * u(random)};
    w.yaw = yaw(random);
  }
  return waypoints;
}

}  // namespace swiftlet::test
