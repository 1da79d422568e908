// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/scan_message.hpp"

namespace swiftlet {

LaserScan from_msg(const sensor_msgs::msg::LaserScan& message) {
  LaserScan scan;
  scan.angle_min = message.angle_min();
  scan.angle_increment = message.angle_increment();
  scan.time_increment = message.time_increment();
  scan.range_min = message.range_min();
  scan.range_max = message.range_max();
  scan.ranges = message.ranges();
  return scan;
}

sensor_msgs::msg::LaserScan to_msg(const LaserScan& scan) {
  sensor_msgs::msg::LaserScan message;
  const double last = scan.ranges.empty() ? 0.0 : static_cast<double>(scan.ranges.size() - 1);
  message.angle_min(static_cast<float>(scan.angle_min));
  message.angle_max(static_cast<float>(scan.angle_min + last * scan.angle_increment));
  message.angle_increment(static_cast<float>(scan.angle_increment));
  message.time_increment(static_cast<float>(scan.time_increment));
  message.range_min(static_cast<float>(scan.range_min));
  message.range_max(static_cast<float>(scan.range_max));
  message.ranges(scan.ranges);
  return message;
}

}  // namespace swiftlet
