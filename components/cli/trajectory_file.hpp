// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/trajectory/minimum_snap_planner.hpp"

namespace swiftlet {

/// What `swiftlet trajectory` reads: where from, through what, within which limits, and how long.
struct TrajectoryFile {
  std::string name;  ///< "" where it has none
  FlatReference start;
  std::vector<Waypoint> waypoints;
  TrajectoryLimits limits;
  std::optional<double> duration_s;  ///< as short as the limits allow where it is not given

  /// Throws ConfigError, with file and line.
  static TrajectoryFile load(const std::filesystem::path& file);
};

}  // namespace swiftlet
