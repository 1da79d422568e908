// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/geometry/pose2.hpp"
#include "perception/slam/scan_points.hpp"

namespace swiftlet {

/// Points with normals, sorted into cells so that the nearest is found at once.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(ScanPoints points, double cell_size = 0.25);

  /// The nearest point with a normal within `cell_size` and `radius`; null where there is none.
  const SurfacePoint* nearest(const Eigen::Vector2d& place, double radius) const;
  bool empty() const { return points_.empty(); }

 private:
  double cell_size_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each cell, and one behind the last
  ScanPoints points_;                 ///< cell by cell
};

struct LineMatchParams {
  int max_iterations = 20;
  double widest_pairs = 0.25;     ///< farthest partners in the first iteration [m]
  double narrowest_pairs = 0.10;  ///< and in the last [m]
  double robust_scale = 0.03;     ///< of Cauchy's weights [m]
  double converged_below = 1e-4;  ///< change of an iteration [m, rad]
};

/// Where the scan is, as something else knows it.
struct PosePrior {
  Pose2 pose;
  Eigen::Matrix3d information;  ///< as LineMatch::information, times sigma^2 of a point
};

struct LineMatch {
  Pose2 pose;
  bool converged = false;
  int iterations = 0;
  /// Sum of weighted J^T J at the solution, per sigma^2 of a point: (x, y, yaw) in the axes of the
  /// map, about the scan's origin. Singular along a corridor.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double inliers = 0.0;  ///< share of the scan's points with a partner within `narrowest_pairs`
  double rms = 0.0;      ///< of the inliers' distances to their lines [m]
};

/// Aligns a scan with surfaces by iterated closest points, each to the line through its partner
/// (Censi, An ICP variant using a point-to-line metric, 2008), with robust weights. Starts from
/// `guess`, which must be within about `widest_pairs` of the truth.
LineMatch match_lines(const SurfaceIndex& map, const ScanPoints& scan, const Pose2& guess,
                      const LineMatchParams& params = {},
                      const std::optional<PosePrior>& prior = std::nullopt);

/// What a match tells least of the position: the direction, in the map, and how many points tell
/// it.
struct LeastKnown {
  Eigen::Vector2d direction;
  double information;
};
LeastKnown least_known(const LineMatch& match);

/// How good the points of a scan are.
struct LineMatchNoise {
  double sigma = 0.03;  ///< of a point's distance to its line [m]
  /// Errors of neighbouring points are alike, of the sensor and of the map: that many points are
  /// worth one.
  double points_alike = 5.0;
  /// Where nothing is seen: of the position [m] and the yaw [rad].
  double unseen = 10.0;

  double variance() const { return sigma * sigma * points_alike; }
};

/// Inverse of the covariance of a match (x, y, yaw), in the axes of a frame that is turned by
/// `yaw` in the map.
Eigen::Matrix3d information_in(const LineMatch& match, double yaw, const LineMatchNoise& noise);

}  // namespace swiftlet
