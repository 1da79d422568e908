// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "planner/trajectory/piecewise_polynomial.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// The answer to the goal with that stamp: a trajectory.
swiftlet_msgs::msg::Trajectory to_msg(const Trajectory& trajectory, Time goal_stamp);
/// The answer where there is none: `status` is BRAKE or FAILED.
swiftlet_msgs::msg::Trajectory no_trajectory_msg(Time now, Time goal_stamp, std::uint8_t status,
                                                 const std::string& failure,
                                                 const std::string& reason);
/// Empty where the message holds none, or nonsense.
Trajectory from_msg(const swiftlet_msgs::msg::Trajectory& message);

}  // namespace swiftlet
