// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What a trajectory takes by looking at many of its moments, in the plainest way.
#pragma once

#include <algorithm>

#include "control/flatness.hpp"
#include "planner/trajectory/limits.hpp"

namespace swiftlet::test {

inline FlatReference moment_of(const TrajectorySegment& segment, double s) {
  FlatReference moment;
  for (int axis = 0; axis < 3; ++axis) {
    moment.velocity[axis] = derivative(segment, axis, s, 1);
    moment.acceleration[axis] = derivative(segment, axis, s, 2);
    moment.jerk[axis] = derivative(segment, axis, s, 3);
  }
  moment.yaw = derivative(segment, kYaw, s, 0);
  moment.yaw_rate = derivative(segment, kYaw, s, 1);
  return moment;
}

/// The body rate is that of the attitude from control/flatness.hpp.
inline TrajectoryExtrema sampled_extrema(const TrajectorySegment& segment, int samples) {
  TrajectoryExtrema seen;
  seen.max_thrust_per_mass = 0.0;
  seen.min_thrust_per_mass = 1e9;
  for (int i = 0; i <= samples; ++i) {
    const FlatReference moment = moment_of(segment, static_cast<double>(i) / samples);
    const double thrust = (moment.acceleration + Eigen::Vector3d(0, 0, kGravity)).norm();
    seen.max_speed = std::max(seen.max_speed, moment.velocity.norm());
    seen.max_acceleration = std::max(seen.max_acceleration, moment.acceleration.norm());
    seen.max_thrust_per_mass = std::max(seen.max_thrust_per_mass, thrust);
    seen.min_thrust_per_mass = std::min(seen.min_thrust_per_mass, thrust);
    seen.max_body_rate = std::max(seen.max_body_rate, flat_state(moment).w_WB_B.norm());
    seen.max_yaw_rate = std::max(seen.max_yaw_rate, std::abs(moment.yaw_rate));
  }
  return seen;
}

}  // namespace swiftlet::test
