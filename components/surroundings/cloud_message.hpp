// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/basics/result.hpp"
#include "sensor_msgs.h"

namespace swiftlet {

/// The points of a cloud in its own frame [m]; those that are not finite are left out. An error
/// where it has no x, y and z of 4 or 8 bytes, or contradicts itself.
Result<std::vector<Eigen::Vector3d>> points_of(const sensor_msgs::msg::PointCloud2& cloud);

}  // namespace swiftlet
