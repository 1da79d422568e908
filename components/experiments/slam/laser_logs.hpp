// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/bag/carmen/carmen_log.hpp"
#include "components/experiments/slam/relations.hpp"

namespace swiftlet {

/// A log of a planar scanner in a folder of data, with what is known of the truth.
struct LaserLogFile {
  std::string name;  ///< X of X_scans.txt.gz or X_raw.log.gz
  std::filesystem::path file;
  std::filesystem::path relations;  ///< with whose name X begins; empty where there are none
};

/// `X_scans.txt.gz` and `X_raw.log.gz` in a folder and below, sorted by name, with the
/// `*.relations` file of the longest name that X begins with.
std::vector<LaserLogFile> find_laser_logs(const std::filesystem::path& folder);

/// Reads either kind. A CARMEN log is one; the lines of a scans file are
///
///     t [odom_x odom_y odom_theta] r0..rN
///
/// with odometry where the first line, a comment, names these columns, and N + 1 beams over 180
/// degrees from -90 degrees on. Ranges from 50 m up are no return. Errors name file and line.
Result<carmen::Log> read_laser_log(const std::filesystem::path& file);

}  // namespace swiftlet
