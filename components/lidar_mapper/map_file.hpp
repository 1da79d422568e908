// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "estimation/basics/result.hpp"
#include "perception/slam/scan_map.hpp"

namespace swiftlet {

/// A map file is an MCAP recording of one moment: `lidar/map`, all that the mapper knows, and
/// `map`, the occupancy map, for those who want to look at it.

/// Written beside the file and put in its place when it is whole.
Status save_map_file(const SlamMap& map, const OccupancyGrid& grid, Time time,
                     const std::filesystem::path& file);

/// Errors name the file and what is wrong with it: not there, no map in it, damaged, contradictory.
Result<SlamMap> load_map_file(const std::filesystem::path& file);

}  // namespace swiftlet
