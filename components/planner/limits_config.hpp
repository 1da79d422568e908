// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "planner/trajectory/limits.hpp"

namespace swiftlet {

/// Reads the limits of trajectories from a mapping: `max_speed`, `max_acceleration`,
/// `max_thrust_per_mass`, `min_thrust_per_mass`, `max_body_rate`, `max_yaw_rate`. What is not given
/// stays as it is. Throws ConfigError.
void read_limits(const Config& config, TrajectoryLimits& limits);

}  // namespace swiftlet
