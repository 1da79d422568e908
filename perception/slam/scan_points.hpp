// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "perception/laser_scan.hpp"

namespace swiftlet {

/// A point of a scan in the plane, with the direction that the surface there faces.
struct SurfacePoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();    ///< unit; zero where no line is seen
  bool has_normal() const { return normal != Eigen::Vector2d::Zero(); }
};
using ScanPoints = std::vector<SurfacePoint>;

struct ScanPointsParams {
  double max_range = 25.0;      ///< returns from beyond are left out [m]
  double normal_radius = 0.30;  ///< neighbours up to that far make the line through a point [m]
  double spacing = 0.04;        ///< of points along a surface; nearer ones are left out [m]
};

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

/// The returns of a scan as points in the plane of H, as it stood at the scan's first beam:
/// levelled, and with the motion between the beams taken out. Each has the normal of the line
/// through its neighbours among the beams.
ScanPoints scan_points(const LaserScan& scan, const ScannerMotion& motion = {},
                       const ScanPointsParams& params = {});

}  // namespace swiftlet
