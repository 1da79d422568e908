// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "estimation/basics/result.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// Writes a grid as the map_server of ROS does: an 8-bit image (0 occupied, 254 free, 205 unknown;
/// its first row is the one with the largest y) and beside it a .yaml file with the same stem that
/// names it. `image` ends in .pgm, or in .png for a picture without the .yaml. A file appears
/// whole, under its name, or not at all. Refuses an empty grid.
Status save_map(const OccupancyGrid& grid, const std::filesystem::path& image);

/// Whether a map could be saved as `image` now, for who has yet to get one.
Status check_map_file(const std::filesystem::path& image);

/// Reads a map in the format of the map_server: trinary and scale modes, negate, P5 and P2 images
/// of 8 or 16 bits and what else OpenCV reads. Thresholds and resolution come from the file, all
/// else from `params`. A map that is turned (yaw of the origin) is refused. Every error names the
/// file and what is wrong in it.
Result<OccupancyGrid> load_map(const std::filesystem::path& yaml,
                               const OccupancyGrid::Params& params = {});

}  // namespace swiftlet
