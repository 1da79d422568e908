// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/component.hpp"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "swiftlet_msgs.h"
#include "tf2_msgs.h"

/// Every topic of the stack: its name, its type and how it is delivered.
namespace swiftlet::topic {

inline constexpr Topic<rosgraph_msgs::msg::Clock> clock{"clock", qos::sensor};

// Sensors.
inline constexpr Topic<sensor_msgs::msg::Imu> imu0{"imu0", qos::sensor};
inline constexpr Topic<sensor_msgs::msg::Imu> imu1{"imu1", qos::sensor};
inline constexpr Topic<sensor_msgs::msg::Imu> imu2{"imu2", qos::sensor};
inline constexpr Topic<sensor_msgs::msg::Range> range_down{"range/down", qos::sensor};
inline constexpr Topic<sensor_msgs::msg::LaserScan> scan{"scan", qos::sensor};
inline constexpr Topic<sensor_msgs::msg::BatteryState> battery{"battery", qos::state};
inline constexpr Topic<geometry_msgs::msg::PoseWithCovarianceStamped> phone_pose{"phone/pose",
                                                                                 qos::sensor};

// Where the vehicle is, and what is around it.
inline constexpr Topic<nav_msgs::msg::Odometry> odometry{"odometry", qos::state};
inline constexpr Topic<tf2_msgs::msg::TFMessage> tf{"tf", qos::state};
inline constexpr Topic<nav_msgs::msg::OccupancyGrid> map{"map", qos::map};

// Where it goes.
inline constexpr Topic<swiftlet_msgs::msg::ModeCommand> mode{"mode", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::Mission> waypoints{"waypoints", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::CommandAck> mode_ack{"mode/ack", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::VehicleStatus> vehicle_status{"vehicle/status",
                                                                         qos::state};
inline constexpr Topic<geometry_msgs::msg::PoseStamped> goal{"goal", qos::command};
inline constexpr Topic<nav_msgs::msg::Path> path{"path", qos::state};
inline constexpr Topic<swiftlet_msgs::msg::Trajectory> trajectory{"trajectory", qos::state};
inline constexpr Topic<swiftlet_msgs::msg::Setpoint> setpoint{"setpoint", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::MotorCommand> motors{"motors", qos::command};

// Who is there, and how it is set.
inline constexpr Topic<swiftlet_msgs::msg::ComponentStatus> component_status{"component/status",
                                                                             qos::state};
inline constexpr Topic<swiftlet_msgs::msg::ParameterRequest> parameter_request{"parameter/request",
                                                                               qos::command};
inline constexpr Topic<swiftlet_msgs::msg::ParameterReply> parameter_reply{"parameter/reply",
                                                                           qos::command};

// What only a simulator knows.
inline constexpr Topic<swiftlet_msgs::msg::SimTruth> sim_truth{"sim/truth", qos::sensor};

}  // namespace swiftlet::topic

namespace swiftlet::frame {

inline constexpr const char* kMap = "map";         ///< world W, ENU
inline constexpr const char* kBody = "base_link";  ///< body B, FLU
inline constexpr const char* kLaser = "laser";

}  // namespace swiftlet::frame
