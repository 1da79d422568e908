// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/exploration/seen_space.hpp"

namespace swiftlet {

/// Where the known free space ends without a wall (Yamauchi, A frontier-based approach for
/// autonomous exploration, CIRA 1997): unseen cells beside open ones that hang together.
struct Frontier {
  std::vector<Cell> cells;  ///< unseen, each with an open neighbour along x or y
  Cell middle;              ///< the cell nearest to their mean
  double area = 0.0;        ///< of the unseen cells that hang together with it [m^2]
};

/// All frontiers of a map, row by row, among the cells for which `matters` says so: only those
/// count, for the area, too. `matters` is a byte a cell, row by row without the rim, zero for no.
/// One that is longer than `extent` [m] along x or y is cut in halves until none is (as in Zhou et
/// al., FUEL, RA-L 2021): a long one is not seen from one place.
std::vector<Frontier> find_frontiers(const SeenSpace& space,
                                     const std::vector<std::uint8_t>& matters, double extent);

}  // namespace swiftlet
