// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "components/static_transforms.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "nav_msgs.h"
#include "perception/voxel_filter.hpp"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace swiftlet {

/// One cloud in the map of all that was scanned: each beam of a scan, or each cloud, at the pose
/// that odometry had when it was taken. Scans come before their odometry, so they wait for it.
class CloudCollector {
 public:
  /// `voxel`: of each cube of so many metres one point is kept.
  explicit CloudCollector(double voxel);

  void hear(const nav_msgs::msg::Odometry& odometry);
  void hear(const tf2_msgs::msg::TFMessage& mounts);
  void hear(const sensor_msgs::msg::LaserScan& scan);
  void hear(const sensor_msgs::msg::PointCloud2& cloud);

  const VoxelFilter& cloud() const { return cloud_; }
  int heard() const { return heard_; }    ///< scans and clouds
  int placed() const { return placed_; }  ///< of them
  /// Why the last that could not be placed could not, as a sentence's end: "no odometry is heard".
  std::string problem() const;

 private:
  /// Points of a moment that wait for the pose.
  struct Waiting {
    Time begin{}, end{};
    std::string frame;
    sensor_msgs::msg::LaserScan scan;
    std::vector<Eigen::Vector3d> points;  // of a cloud; else the scan is meant
  };
  void wait(Waiting waiting);
  void place_waiting();
  void place(const Waiting& waiting);
  void take(const std::vector<Eigen::Vector3d>& points);

  VoxelFilter cloud_;
  StaticTransforms mounts_;
  PoseHistory body_;
  std::string body_frame_;
  std::deque<Waiting> waiting_;
  std::string problem_;
  int heard_ = 0;
  int placed_ = 0;
};

}  // namespace swiftlet
