// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "perception/voxel_grid.hpp"
#include "planner/any_angle/taut_line.hpp"

namespace swiftlet {

/// Draws a map of the plane, or the layer of a map of space in the middle of the first line, with
/// lines across it, into a PNG file.
Status draw_map(const VoxelGrid& grid, const std::vector<SpaceLine>& lines,
                const std::string& title, const std::filesystem::path& file);

}  // namespace swiftlet
