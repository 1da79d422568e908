// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/scan_motion.hpp"

#include <algorithm>

#include "components/conversions.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

constexpr double kLongestTurn = 1.0;  // of a scanner that is to be believed [s]

}  // namespace

Pose2 planar(const PoseHistory::Pose& pose) {
  return {pose.position.head<2>(), yaw_of(pose.attitude)};
}

ScannerMotion scanner_motion(const sensor_msgs::msg::LaserScan& scan,
                             const PoseHistory::Pose& scanner, const PoseHistory& body,
                             const StaticTransforms::Pose& mount, Duration max_gap) {
  ScannerMotion motion;
  motion.q_HL = from_yaw(-yaw_of(scanner.attitude)) * scanner.attitude;
  motion.height = scanner.position.z();
  const double seconds =
      static_cast<double>(scan.time_increment()) * static_cast<double>(scan.ranges().size());
  if (!(seconds > 0.0 && seconds < kLongestTurn)) return motion;
  // What is known of the body by now may end before the scan does.
  const Time begin = from_msg(scan.header().stamp());
  const Time end = std::min(body.newest(), begin + from_seconds(seconds));
  const auto later = body.at(end, max_gap);
  const double passed = to_seconds(end - begin);
  if (!later || !(passed > 0.0)) return motion;
  const Pose2 moved = planar(scanner).inverse() * planar(scanner_on(*later, mount));
  motion.velocity = moved.position / passed;
  motion.yaw_rate = moved.yaw / passed;
  return motion;
}

}  // namespace swiftlet
