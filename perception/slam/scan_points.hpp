// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "perception/levelled_scan.hpp"

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

/// The returns of a scan as points in the plane of H, as it stood at the scan's first beam:
/// levelled, and with the motion between the beams taken out. Each has the normal of the line
/// through its neighbours among the beams.
ScanPoints scan_points(const LaserScan& scan, const ScannerMotion& motion = {},
                       const ScanPointsParams& params = {});

}  // namespace swiftlet
