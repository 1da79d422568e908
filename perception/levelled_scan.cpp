// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/levelled_scan.hpp"

#include <cmath>

namespace swiftlet {

std::vector<LevelledReturn> levelled_returns(const LaserScan& scan, const ScannerMotion& motion,
                                             double max_range) {
  std::vector<LevelledReturn> returns;
  returns.reserve(scan.ranges.size());
  const Eigen::Matrix3d R_HL = motion.q_HL.normalized().toRotationMatrix();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range >= scan.range_min && range < scan.range_max && range <= max_range)) continue;
    const double beam = static_cast<double>(i);
    const double angle = scan.angle_min + beam * scan.angle_increment;
    const Eigen::Vector3d p_H =
        range * (R_HL.col(0) * std::cos(angle) + R_HL.col(1) * std::sin(angle));
    const double height = motion.height + p_H.z();
    if (height < motion.min_height || height > motion.max_height) continue;
    const double later = beam * scan.time_increment;
    const Eigen::Vector2d point =
        motion.velocity * later +
        Eigen::Rotation2Dd(motion.yaw_rate * later) * Eigen::Vector2d(p_H.head<2>());
    if (!point.allFinite() || point.norm() > 2.0 * max_range) continue;  // its times are nonsense
    returns.push_back({point, range, i});
  }
  return returns;
}

}  // namespace swiftlet
