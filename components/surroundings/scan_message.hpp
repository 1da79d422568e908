// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "perception/laser_scan.hpp"
#include "sensor_msgs.h"

namespace swiftlet {

/// A scan without its header, and the other way round; intensities are left out.
LaserScan from_msg(const sensor_msgs::msg::LaserScan& message);
sensor_msgs::msg::LaserScan to_msg(const LaserScan& scan);

}  // namespace swiftlet
