// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nav_msgs.h"

namespace swiftlet {

/// The same map in cells of at least `resolution` [m], whole multiples of the old ones. A cell is
/// as occupied as the most occupied of those that it covers, and unknown where all of them are: an
/// obstacle is never lost. Unchanged where it is as coarse already, or contradicts itself.
nav_msgs::msg::OccupancyGrid coarsened(const nav_msgs::msg::OccupancyGrid& map, double resolution);

}  // namespace swiftlet
