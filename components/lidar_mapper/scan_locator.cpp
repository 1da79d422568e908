// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/scan_locator.hpp"

#include <algorithm>
#include <utility>

#include "components/conversions.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/surroundings/scan_motion.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Variance of what a planar scanner does not see: height [m^2], roll and pitch [rad^2].
constexpr double kUnseen = 1e6;

Time stamp(const sensor_msgs::msg::LaserScan& scan) {
  return from_msg(scan.header().stamp());
}

RowMajor6d covariance_of(const Eigen::Matrix3d& planar_covariance) {
  RowMajor6d covariance = kUnseen * RowMajor6d::Identity();
  constexpr int kSeen[] = {0, 1, 5};  // x, y, yaw
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) covariance(kSeen[i], kSeen[j]) = planar_covariance(i, j);
  }
  return covariance;
}

}  // namespace

ScanLocator::ScanLocator(const MapperParams& params, Mailbox& mailbox, const Executor& executor,
                         std::optional<KnownPlace> place)
    : params_(params), slam_(params.lidar_slam, params.grid, mailbox, executor, std::move(place)) {}

geometry_msgs::msg::PoseWithCovarianceStamped ScanLocator::locate(
    const sensor_msgs::msg::LaserScan& message, const PoseHistory& odometry,
    const StaticTransforms::Pose& mount) {
  const auto body = odometry.at(stamp(message), from_seconds(params_.max_odometry_gap));
  std::optional<Pose2> moved;
  if (body) {
    const PoseHistory::Pose scanner = scanner_on(*body, mount);
    moved = planar(scanner);
    motion_ =
        scanner_motion(message, scanner, odometry, mount, from_seconds(params_.max_odometry_gap));
    motion_.min_height = params_.grid.min_height;
    motion_.max_height = params_.grid.max_height;
  } else {
    // Nobody says how it moves and is tilted: as a body that hovers, where it was last.
    motion_.q_HL = from_yaw(-yaw_of(mount.attitude)) * mount.attitude;
    motion_.velocity.setZero();
    motion_.yaw_rate = 0.0;
    if (odometry.empty()) {
      motion_.height = 0.5 * (params_.grid.min_height + params_.grid.max_height);
    }
  }
  mount_ = mount;
  const LidarSlam::Update update = slam_.add(stamp(message), from_msg(message), motion_, moved);
  lost_ = update.lost;

  geometry_msgs::msg::PoseWithCovarianceStamped pose;
  pose.header(make_header(stamp(message), frame::kMap));
  const PoseHistory::Pose at = body_at(update.pose);
  pose.pose().pose(to_pose(at.position, at.attitude));
  Eigen::Map<RowMajor6d>(pose.pose().covariance().data()) = covariance_of(update.covariance);
  return pose;
}

/// Of the body, when the scanner's levelled frame is at `pose`.
PoseHistory::Pose ScanLocator::body_at(const Pose2& pose) const {
  const Eigen::Quaterniond q_WL = from_yaw(pose.yaw) * motion_.q_HL;
  const Eigen::Quaterniond q_WB = q_WL * mount_.attitude.conjugate();
  const Eigen::Vector3d p_WL(pose.position.x(), pose.position.y(), motion_.height);
  return {p_WL - q_WB * mount_.position, q_WB};
}

nav_msgs::msg::Path ScanLocator::path(Time now) const {
  nav_msgs::msg::Path path;
  path.header(make_header(now, frame::kMap));
  for (const LidarSlam::TimedPose& timed : slam_.slam().trajectory()) {
    geometry_msgs::msg::PoseStamped pose;
    pose.header(make_header(timed.time, frame::kMap));
    const PoseHistory::Pose body = body_at(timed.pose);
    pose.pose(to_pose(body.position, body.attitude));
    path.poses().push_back(pose);
  }
  return path;
}

}  // namespace swiftlet
