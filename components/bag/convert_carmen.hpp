// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "components/bag/carmen/carmen_log.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Of the scanners on the robots that CARMEN ran on [m].
inline constexpr double kUsualLaserHeight = 0.4;

struct Conversion {
  std::size_t scans = 0;
  std::size_t poses = 0;
  std::size_t skipped_lines = 0;
  bool corrected = false;
};

/// Writes a CARMEN log as MCAP, in the order of time and with the log's own clock:
///
/// - `scan` (sensor_msgs/msg/LaserScan, frame `laser`); no return is +infinity (REP-117)
/// - `odometry` (nav_msgs/msg/Odometry): pose of frame `laser`. For every scan with a pose there
///   is one with the stamp of the scan, in front of it. In a corrected log these are all, in frame
///   `map`; else the ODOM lines between the scans are there too, in frame `odom`.
///
/// `output` appears, or is replaced, only when all went well.
/// CARMEN logs are flat. `laser_height` [m] is the z of the poses, so that who maps with them can
/// tell obstacles from the floor.
Result<Conversion> convert_carmen(const carmen::Log& log, const std::filesystem::path& output,
                                  double laser_height = kUsualLaserHeight);

}  // namespace swiftlet
