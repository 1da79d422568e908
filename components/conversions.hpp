// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "components/runtime/stamp.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"
#include "swiftlet_msgs.h"

/// Between the algorithms' values and the messages. Every component converts with these.
namespace swiftlet {

geometry_msgs::msg::Point to_point(const Eigen::Vector3d& v);
geometry_msgs::msg::Vector3 to_vector3(const Eigen::Vector3d& v);
geometry_msgs::msg::Quaternion to_msg(const Eigen::Quaterniond& q);
geometry_msgs::msg::Pose to_pose(const Eigen::Vector3d& p, const Eigen::Quaterniond& q);
Eigen::Vector3d from_msg(const geometry_msgs::msg::Point& p);
Eigen::Vector3d from_msg(const geometry_msgs::msg::Vector3& v);
/// As it is: not normalised, not checked.
Eigen::Quaterniond from_msg(const geometry_msgs::msg::Quaternion& q);

/// nav_msgs/Odometry has the velocity in the body frame, RigidBodyState in the world.
nav_msgs::msg::Odometry to_odometry(Time time, const RigidBodyState& state);
RigidBodyState from_msg(const nav_msgs::msg::Odometry& odometry);

ImuSample from_msg(const sensor_msgs::msg::Imu& imu);

/// Fills in the reference of a setpoint.
void set_reference(const FlatReference& reference, swiftlet_msgs::msg::Setpoint& setpoint);
FlatReference reference_of(const swiftlet_msgs::msg::Setpoint& setpoint);

}  // namespace swiftlet
