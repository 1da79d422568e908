// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/planner/limits_config.hpp"

#include <string>

namespace swiftlet {
namespace {

/// A limit that may be infinite, which no file can say: it is read where it is given.
void read_given(const Config& config, const std::string& key, double& value, Range range) {
  if (config.has(key)) config.read(key, value, range);
}

}  // namespace

void read_limits(const Config& config, TrajectoryLimits& limits) {
  // A hover must be within the limits, with room to fly.
  constexpr double kRoom = 0.01;  // [m/s^2]
  const Range above_hover{kGravity + kRoom, Range().max};
  const Range below_hover{0.0, kGravity - kRoom};
  config.read("max_speed", limits.max_speed, kPositive);
  config.read("max_acceleration", limits.max_acceleration, kPositive);
  read_given(config, "max_thrust_per_mass", limits.max_thrust_per_mass, above_hover);
  read_given(config, "min_thrust_per_mass", limits.min_thrust_per_mass, below_hover);
  read_given(config, "max_body_rate", limits.max_body_rate, kPositive);
  read_given(config, "max_yaw_rate", limits.max_yaw_rate, kPositive);
}

}  // namespace swiftlet
