// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

#include "perception/laser_scan.hpp"

namespace swiftlet {

/// How the scanner was held and moved while it took a scan.
struct ScannerMotion {
  /// Attitude of the scanner's frame L in a frame H beneath the same origin that is level and looks
  /// the same way: roll and pitch without yaw.
  Eigen::Quaterniond q_HL = Eigen::Quaterniond::Identity();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< in H [m/s]
  double yaw_rate = 0.0;                               ///< [rad/s]
  double height = 0.0;                                 ///< of the scanner [m]
  /// Returns from below or above are the floor's or the ceiling's, and left out [m].
  double min_height = -std::numeric_limits<double>::infinity();
  double max_height = std::numeric_limits<double>::infinity();
};

/// A return of a scan in the plane.
struct LevelledReturn {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< in H, as it stood at the first beam [m]
  double range = 0.0;                                  ///< as it was measured [m]
  std::size_t beam = 0;
};

/// The returns of a scan up to `max_range` [m] in the order of the beams: levelled, and with the
/// motion between the beams taken out.
std::vector<LevelledReturn> levelled_returns(const LaserScan& scan, const ScannerMotion& motion,
                                             double max_range);

}  // namespace swiftlet
