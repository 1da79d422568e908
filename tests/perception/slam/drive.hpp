// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "perception/slam/lidar_slam.hpp"
#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {

inline constexpr double kRate_hz = 4.5;
inline constexpr double kSpeed = 0.6;  // [m/s]

inline Time at(double seconds) {
  return Time{} + from_seconds(seconds);
}

/// From corner to corner, turning on the spot at each.
inline std::vector<Pose2> way_along(const std::vector<Eigen::Vector2d>& corners, double yaw) {
  std::vector<Pose2> way;
  const double step = kSpeed / kRate_hz, turn = 0.8 / kRate_hz;
  for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg) {
    const Eigen::Vector2d from = corners[leg], to = corners[leg + 1];
    const double heading = std::atan2((to - from).y(), (to - from).x());
    for (; std::abs(wrap_angle(heading - yaw)) > turn; yaw = wrap_angle(yaw + turn)) {
      way.push_back({from, yaw});
    }
    yaw = heading;
    const double length = (to - from).norm();
    for (double d = 0.0; d < length; d += step) {
      way.push_back({from + (to - from) * (d / length), yaw});
    }
  }
  return way;
}

/// The way around the block of office_floor, `rounds` times.
inline std::vector<Pose2> way_around(double rounds) {
  const std::vector<Eigen::Vector2d> block{{1.5, 1.5}, {22.3, 1.6}, {22.2, 12.4}, {1.7, 12.3}};
  std::vector<Eigen::Vector2d> corners;
  const auto legs = static_cast<std::size_t>(std::lround(4 * rounds));
  for (std::size_t leg = 0; leg <= legs; ++leg) corners.push_back(block[leg % block.size()]);
  return way_along(corners, 0.0);
}

/// Drives along the poses of `way`; the back end hears of each job and answers `late` scans later.
class Drive {
 public:
  explicit Drive(unsigned seed, FloorPlan plan = office_floor())
      : plan_(std::move(plan)), random_(seed) {}

  LidarSlam::Update see(const Pose2& pose, double seconds,
                        const std::optional<Pose2>& odometry = std::nullopt) {
    const LaserScan scan = plan_.scan(pose, 360, field_of_view, 0.01, random_);
    const auto update = slam.add(at(seconds), scan_points(scan), odometry);
    truth.push_back(pose);
    live.push_back(slam.trajectory().back().pose);
    lost += update.lost ? 1 : 0;
    if (!result_ && slam.has_job()) {
      result_ = LidarSlam::run_back_end(slam.take_job());
      due_ = truth.size() + late;
    }
    if (result_ && truth.size() >= due_) {
      closures += result_->closures.size();
      slam.apply(*result_);
      result_.reset();
    }
    return update;
  }
  void along(const std::vector<Pose2>& way) {
    for (const Pose2& pose : way) see(pose, static_cast<double>(truth.size()) / kRate_hz);
  }

  /// Distances between where scans were taken and where they are thought to be [m].
  std::vector<double> errors(const std::vector<Pose2>& poses) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose2 true_pose = truth.front().inverse() * truth[i];
      result.push_back((poses[i].position - true_pose.position).norm());
    }
    return result;
  }
  std::vector<Pose2> now() const {
    std::vector<Pose2> poses;
    for (const auto& timed : slam.trajectory()) poses.push_back(timed.pose);
    return poses;
  }

  LidarSlam slam;
  double field_of_view = 1.5 * M_PI;
  std::size_t late = 0;
  std::vector<Pose2> truth, live;
  int lost = 0;
  std::size_t closures = 0;

 private:
  FloorPlan plan_;
  std::mt19937 random_;
  std::optional<LidarSlam::BackEndResult> result_;
  std::size_t due_ = 0;
};

inline double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}
inline double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace swiftlet::test
