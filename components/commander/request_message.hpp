// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "control/flight_director.hpp"
#include "geometry_msgs.h"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What a command asks for; nothing where there is no such command.
std::optional<Request> request_of(const swiftlet_msgs::msg::ModeCommand& command);

/// Where a goal leads, as RViz's "2D Goal Pose" and its like send it: place and heading of its
/// pose. A height of exactly 0, all that a tool on a plane can say, stands for `altitude` [m]. An
/// error where the pose is not in the map, or is no pose.
Result<MissionWaypoint> waypoint_of(const geometry_msgs::msg::PoseStamped& goal, double altitude);

/// Of the mission that a goal is: the same for the same pose, whenever it was sent.
std::uint32_t goal_identity(const geometry_msgs::msg::PoseStamped& goal);

/// Of the message: the same for the same pose with the same stamp.
std::string goal_id(const geometry_msgs::msg::PoseStamped& goal);

/// Without a stamp, as `ros2 topic pub` sends it, nobody can tell a goal that is asked for again
/// from one that comes a second time.
bool has_stamp(const geometry_msgs::msg::PoseStamped& goal);

/// The answer to a command, with its identity, its name and its station; what became of it is still
/// to be said.
swiftlet_msgs::msg::CommandAck asked(const swiftlet_msgs::msg::ModeCommand& command);
swiftlet_msgs::msg::CommandAck asked(const swiftlet_msgs::msg::Mission& mission);
swiftlet_msgs::msg::CommandAck asked(const geometry_msgs::msg::PoseStamped& goal);

/// Why what was asked for is not done, with its name.
Error refused(const swiftlet_msgs::msg::CommandAck& asked, const Error& why);

}  // namespace swiftlet
