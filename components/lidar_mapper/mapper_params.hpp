// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "components/runtime/config/config.hpp"
#include "perception/occupancy_grid.hpp"
#include "perception/slam/lidar_slam.hpp"

namespace swiftlet {

struct MapperParams {
  OccupancyGrid::Params grid;
  double map_rate_hz = 5.0;
  double max_odometry_gap = 0.5;  ///< longer ones are not interpolated across [s]
  bool slam = false;              ///< find the poses, too, instead of taking odometry's
  LidarSlam::Params lidar_slam;
  std::filesystem::path load;       ///< map file of a place that was mapped before; empty for none
  bool stay = false;                ///< leave the map that was loaded as it is
  std::optional<Pose2> first_pose;  ///< of the scanner in that map, at the first scan
  std::filesystem::path save;       ///< map file to write; empty for none
};

/// From the section of a `lidar_mapper`. Throws ConfigError.
MapperParams read_mapper_params(const Config& config);

}  // namespace swiftlet
