// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <map>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

/// Laser logs of CARMEN, the Carnegie Mellon robot navigation toolkit: one message a line,
///
///     FLASER n r1..rn laser_x laser_y laser_theta odom_x odom_y odom_theta ipc_time host
///     logger_time ODOM x y theta tv rv acceleration ipc_time host logger_time ROBOTLASER1 type
///     start_angle field_of_view resolution max_range accuracy remission_mode
///         n r1..rn m i1..im laser_x laser_y laser_theta robot_x robot_y robot_theta
///         tv rv forward_safety side_safety turn_axis ipc_time host logger_time
///     RAWLASER1 type ... n r1..rn m i1..im ipc_time host logger_time
///     PARAM name value ...
namespace swiftlet::carmen {

struct Params {
  /// Ranges from here on are "no return" [m]: SICK scanners report 81.83 or 81.91, converted logs
  /// 50. A smaller maximum in the log itself (ROBOTLASER, or PARAM robot_front_laser_max) counts.
  double max_range = 50.0;
};

/// Position [m] and heading [rad, counter-clockwise] in the plane.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;
};

struct Scan {
  Time time;                       ///< of the measurement: ipc_time
  double angle_min = 0.0;          ///< of the first beam, in the frame of the laser [rad]
  double angle_increment = 0.0;    ///< counter-clockwise [rad]
  double max_range = 0.0;          ///< [m]
  std::vector<float> ranges;       ///< [m]; no return is +infinity, never NaN
  std::vector<float> intensities;  ///< remissions; empty where the log has none
  bool has_pose = false;           ///< RAWLASER has none
  Pose laser_pose;                 ///< in the world: corrected, where somebody corrected the log
  Pose robot_pose;                 ///< as the odometry says
  std::size_t line = 0;
};

struct Odometry {
  Time time;                   ///< ipc_time
  Pose pose;                   ///< of the robot
  double forward_speed = 0.0;  ///< [m/s]
  double yaw_rate = 0.0;       ///< [rad/s]
  std::size_t line = 0;
};

/// A log in the order of time; lines of the same time keep their order. The clock is that of
/// ipc_time, when a message was made; logger_time, when it was written down, comes later and counts
/// from the start of the logger. A line with time 0 has the time of the line before it.
struct Log {
  std::vector<Scan> scans;
  std::vector<Odometry> odometry;
  std::map<std::string, std::string> parameters;
  std::map<std::string, std::size_t> skipped;  ///< lines of kinds that are not used, by keyword
  std::size_t lines = 0;

  /// The laser poses come from a mapping program: the log was written by GMapping (NEFF lines), or
  /// the laser moves relative to the robot. The odometry lines are then not in their frame.
  bool corrected = false;
  /// Of the laser on the robot, where !corrected.
  Pose laser_on_robot;
};

/// Reads a log, gzip-compressed or not. Errors name file, line, problem and remedy.
Result<Log> read_log(const std::filesystem::path& path, const Params& params = {});

/// The same from a stream; `name` stands for the file.
Result<Log> parse_log(std::istream& text, const std::string& name, const Params& params = {});

/// Pose of `b` in the frame that `a` is given in, where `b` is given relative to `a`.
Pose compose(const Pose& a, const Pose& b);

}  // namespace swiftlet::carmen
