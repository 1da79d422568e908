// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/component.hpp"
#include "components/runtime/topic.hpp"
#include "diagnostic_msgs.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "swiftlet_msgs.h"
#include "tf2_msgs.h"

/// Every topic of the stack: its name, its type, how it is delivered, and how often.
namespace swiftlet::topic {

using namespace std::chrono_literals;

inline constexpr Topic<rosgraph_msgs::msg::Clock> clock{"clock", qos::sensor, 10ms};

// Sensors.
inline constexpr Topic<sensor_msgs::msg::Imu> imu0{"imu0", qos::sensor, 1ms};
inline constexpr Topic<sensor_msgs::msg::Imu> imu1{"imu1", qos::sensor, 5ms};
inline constexpr Topic<sensor_msgs::msg::Imu> imu2{"imu2", qos::sensor, 50ms};
inline constexpr Topic<sensor_msgs::msg::Range> range_down{"range/down", qos::sensor, 50ms};
inline constexpr Topic<sensor_msgs::msg::LaserScan> scan{"scan", qos::sensor, 100ms};
inline constexpr Topic<sensor_msgs::msg::BatteryState> battery{"battery", qos::state, 1s};
inline constexpr Topic<geometry_msgs::msg::PoseWithCovarianceStamped> phone_pose{"phone/pose",
                                                                                 qos::sensor, 34ms};

inline constexpr Topic<sensor_msgs::msg::NavSatFix> gps_fix{"gps/fix", qos::sensor, 200ms};

// Where the vehicle is, and what is around it.
inline constexpr Topic<nav_msgs::msg::Odometry> odometry{"odometry", qos::state, 10ms};
inline constexpr Topic<tf2_msgs::msg::TFMessage> tf{"tf", qos::state};
/// Where sensors sit. Each driver says it of its own, so a reader keeps more than one message.
inline constexpr Topic<tf2_msgs::msg::TFMessage> tf_static{"tf_static",
                                                           qos::keeping(qos::map, 100)};
inline constexpr Topic<nav_msgs::msg::OccupancyGrid> map{"map", qos::map, 200ms};
/// Of the body, by scans and map.
inline constexpr Topic<geometry_msgs::msg::PoseWithCovarianceStamped> lidar_pose{"lidar/pose",
                                                                                 qos::sensor};
/// All of these poses, as they are known by now.
inline constexpr Topic<nav_msgs::msg::Path> lidar_path{"lidar/path", qos::map};

// Where it goes.
inline constexpr Topic<swiftlet_msgs::msg::ModeCommand> mode{"mode", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::Mission> waypoints{"waypoints", qos::command};
/// A mission of one waypoint, from RViz's "2D Goal Pose" and its like. It is said once, so it must
/// not get lost: reliable, as those tools offer by default.
inline constexpr Topic<geometry_msgs::msg::PoseStamped> goal_pose{"goal_pose", qos::command};
/// Who steers: remote control and ground stations, 20 times a second. All of them are heard, and
/// the commander says whose word counts.
inline constexpr Topic<swiftlet_msgs::msg::ManualControl> manual_control{"manual_control",
                                                                         qos::command};
/// That a ground station is there, and to be missed until it says that it leaves; all of them are
/// heard.
inline constexpr Topic<swiftlet_msgs::msg::ComponentStatus> gcs_heartbeat{"gcs/heartbeat",
                                                                          qos::state};
/// A mission on its way to the vehicle, in parts that are repeated until the vehicle has them all.
inline constexpr Topic<swiftlet_msgs::msg::MissionPart> mission_upload{"mission/upload",
                                                                       qos::sensor};
inline constexpr Topic<swiftlet_msgs::msg::MissionFetch> mission_fetch{"mission/fetch",
                                                                       qos::sensor};
/// Parts of the vehicle's mission, to who asked for them.
inline constexpr Topic<swiftlet_msgs::msg::MissionPart> mission_download{"mission/download",
                                                                         qos::sensor};
inline constexpr Topic<swiftlet_msgs::msg::MissionState> mission_state{"mission/state", qos::state,
                                                                       500ms};
inline constexpr Topic<swiftlet_msgs::msg::FlightLimits> vehicle_limits{"vehicle/limits", qos::map};
/// All of it, for a standby.
inline constexpr Topic<swiftlet_msgs::msg::MissionPart> commander_mission{"commander/mission",
                                                                          qos::map};
inline constexpr Topic<swiftlet_msgs::msg::CommandAck> mode_ack{"mode/ack", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::VehicleStatus> vehicle_status{"vehicle/status",
                                                                         qos::state, 100ms};
inline constexpr Topic<swiftlet_msgs::msg::CommanderState> commander_state{"commander/state",
                                                                           qos::map};
inline constexpr Topic<geometry_msgs::msg::PoseStamped> goal{"goal", qos::command};
/// Where to look next, while an exploration is flown.
inline constexpr Topic<swiftlet_msgs::msg::Exploration> exploration{"exploration", qos::state};
inline constexpr Topic<nav_msgs::msg::Path> path{"path", qos::state};
inline constexpr Topic<swiftlet_msgs::msg::Trajectory> trajectory{"trajectory", qos::map};
inline constexpr Topic<swiftlet_msgs::msg::Setpoint> setpoint{"setpoint", qos::command, 10ms};
/// What is flown instead, while the guard acts.
inline constexpr Topic<swiftlet_msgs::msg::Setpoint> guard_setpoint{"guard/setpoint", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::GuardStatus> guard_status{"guard/status", qos::state,
                                                                     100ms};
inline constexpr Topic<swiftlet_msgs::msg::MotorCommand> motors{"motors", qos::command, 4ms};

// What it carries.
inline constexpr Topic<swiftlet_msgs::msg::ClawCommand> claw_command{"claw/command", qos::command};
inline constexpr Topic<swiftlet_msgs::msg::ClawState> claw_state{"claw/state", qos::state, 100ms};
inline constexpr Topic<swiftlet_msgs::msg::ServoCommand> claw_servo{"claw/servo", qos::command,
                                                                    20ms};
inline constexpr Topic<swiftlet_msgs::msg::ServoFeedback> claw_feedback{"claw/feedback",
                                                                        qos::sensor, 20ms};

/// All that matters of a vehicle, for a link that carries little.
inline constexpr Topic<swiftlet_msgs::msg::Telemetry> telemetry{"telemetry", qos::sensor, 200ms};

/// How well things go, for people: read by every ROS 2 diagnostics viewer.
inline constexpr Topic<diagnostic_msgs::msg::DiagnosticArray> diagnostics{"diagnostics",
                                                                          qos::state};

// What only a simulator knows.
inline constexpr Topic<swiftlet_msgs::msg::SimTruth> sim_truth{"sim/truth", qos::sensor, 10ms};

/// The names of all, for who takes one from a person; a test compares them with the above.
inline constexpr const char* names[] = {clock.name,
                                        imu0.name,
                                        imu1.name,
                                        imu2.name,
                                        range_down.name,
                                        scan.name,
                                        battery.name,
                                        phone_pose.name,
                                        gps_fix.name,
                                        odometry.name,
                                        tf.name,
                                        tf_static.name,
                                        map.name,
                                        lidar_pose.name,
                                        lidar_path.name,
                                        mode.name,
                                        waypoints.name,
                                        goal_pose.name,
                                        manual_control.name,
                                        gcs_heartbeat.name,
                                        mode_ack.name,
                                        mission_upload.name,
                                        mission_fetch.name,
                                        mission_download.name,
                                        mission_state.name,
                                        vehicle_limits.name,
                                        commander_mission.name,
                                        vehicle_status.name,
                                        goal.name,
                                        exploration.name,
                                        path.name,
                                        trajectory.name,
                                        setpoint.name,
                                        guard_setpoint.name,
                                        guard_status.name,
                                        motors.name,
                                        claw_command.name,
                                        claw_state.name,
                                        claw_servo.name,
                                        claw_feedback.name,
                                        telemetry.name,
                                        component_status.name,
                                        parameter_request.name,
                                        parameter_reply.name,
                                        sim_truth.name,
                                        commander_state.name,
                                        diagnostics.name};

}  // namespace swiftlet::topic

namespace swiftlet::frame {

inline constexpr const char* kMap = "map";         ///< world W, ENU
inline constexpr const char* kBody = "base_link";  ///< body B, FLU
// Of sensors, whose places on the body are on tf_static.
inline constexpr const char* kLaser = "laser";
inline constexpr const char* kImu[] = {"imu0", "imu1", "imu2"};
inline constexpr const char* kRangeDown = "range_down";  ///< its x axis is that of the beam

}  // namespace swiftlet::frame
