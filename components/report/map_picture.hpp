// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimation/basics/result.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// A grid as a picture: what is known of it, and what shall be seen besides.
struct MapPicture {
  std::vector<std::uint8_t> png;  ///< grey; black occupied, white free, unknown transparent
  Eigen::Vector2d lower, upper;   ///< corners in the map [m]
  int cells_per_pixel = 1;        ///< along an edge; of several the most occupied one is drawn
};

/// Draws the part of the grid that is not unknown, with at most `most_pixels` along an edge.
/// Nothing where all is unknown.
Result<std::optional<MapPicture>> draw_map(const OccupancyGrid& grid, int most_pixels = 1500);

}  // namespace swiftlet
