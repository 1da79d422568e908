// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/map_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "components/conversions.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

swiftlet_maps::msg::LidarKeyframe to_keyframe(const LevelledScan& scan, const Pose2& pose,
                                              Time time) {
  swiftlet_maps::msg::LidarKeyframe message;
  message.scan(to_msg(scan.scan));
  message.scan().header(make_header(time, frame::kMap));
  message.x(pose.position.x());
  message.y(pose.position.y());
  message.yaw(pose.yaw);
  message.tilt(to_msg(scan.motion.q_HL));
  message.height(scan.motion.height);
  message.min_height(scan.motion.min_height);
  message.max_height(scan.motion.max_height);
  message.velocity_x(scan.motion.velocity.x());
  message.velocity_y(scan.motion.velocity.y());
  message.yaw_rate(scan.motion.yaw_rate);
  return message;
}

LevelledScan scan_of(const swiftlet_maps::msg::LidarKeyframe& message) {
  LevelledScan scan{from_msg(message.scan()), {}};
  scan.motion.q_HL = from_msg(message.tilt());
  scan.motion.height = message.height();
  scan.motion.min_height = message.min_height();
  scan.motion.max_height = message.max_height();
  scan.motion.velocity = {message.velocity_x(), message.velocity_y()};
  scan.motion.yaw_rate = message.yaw_rate();
  return scan;
}

bool is_sound(const LevelledScan& scan) {
  const LaserScan& beams = scan.scan;
  const ScannerMotion& motion = scan.motion;
  constexpr double kUnit = 1e-3;  // off the length of a unit quaternion
  return std::isfinite(beams.angle_min) && std::isfinite(beams.angle_increment) &&
         std::isfinite(beams.time_increment) && std::isfinite(beams.range_min) &&
         std::isfinite(beams.range_max) && std::abs(motion.q_HL.norm() - 1.0) < kUnit &&
         std::isfinite(motion.height) && !std::isnan(motion.min_height) &&
         !std::isnan(motion.max_height) && motion.velocity.allFinite() &&
         std::isfinite(motion.yaw_rate);
}

}  // namespace

swiftlet_maps::msg::LidarMap to_msg(const SlamMap& map, Time time) {
  swiftlet_maps::msg::LidarMap message;
  message.header(make_header(time, frame::kMap));
  for (std::size_t i = 0; i < map.scans.size(); ++i) {
    message.keyframes().push_back(
        to_keyframe(*map.scans[i], map.graph.poses[i], map.graph.keyframes[i]->time));
  }
  for (const PoseConstraint& constraint : map.graph.constraints) {
    swiftlet_maps::msg::LidarConstraint edge;
    edge.from(static_cast<std::uint32_t>(constraint.from));
    edge.to(static_cast<std::uint32_t>(constraint.to));
    edge.x(constraint.relative.position.x());
    edge.y(constraint.relative.position.y());
    edge.yaw(constraint.relative.yaw);
    Eigen::Map<RowMajor3d>(edge.information().data()) = constraint.information;
    edge.robust(constraint.robust);
    message.constraints().push_back(edge);
  }
  return message;
}

Result<SlamMap> from_msg(const swiftlet_maps::msg::LidarMap& message) {
  SlamMap map;
  for (const auto& keyframe : message.keyframes()) {
    LevelledScan scan = scan_of(keyframe);
    const Pose2 pose{{keyframe.x(), keyframe.y()}, keyframe.yaw()};
    if (!is_sound(scan) || !pose.vector().allFinite()) {
      return Error{fmt::format("keyframe {} has numbers that are none", map.scans.size())};
    }
    scan.motion.q_HL.normalize();
    const Time time = from_msg(keyframe.scan().header().stamp());
    map.graph.keyframes.push_back(std::make_shared<const Keyframe>(
        make_keyframe(time, scan_points(scan.scan, scan.motion), std::nullopt)));
    map.graph.poses.push_back(pose);
    map.scans.push_back(std::make_shared<const LevelledScan>(std::move(scan)));
  }
  const auto count = static_cast<std::uint32_t>(map.scans.size());
  for (const auto& edge : message.constraints()) {
    PoseConstraint constraint{static_cast<int>(edge.from()),
                              static_cast<int>(edge.to()),
                              {{edge.x(), edge.y()}, edge.yaw()},
                              Eigen::Map<const RowMajor3d>(edge.information().data()),
                              edge.robust()};
    if (edge.from() >= count || edge.to() >= count || edge.from() == edge.to()) {
      return Error{fmt::format("constraint {} is between keyframes {} and {} of {}",
                               map.graph.constraints.size(), edge.from(), edge.to(), count)};
    }
    if (!constraint.relative.vector().allFinite() || !constraint.information.allFinite()) {
      return Error{
          fmt::format("constraint {} has numbers that are none", map.graph.constraints.size())};
    }
    map.graph.constraints.push_back(constraint);
  }
  return map;
}

}  // namespace swiftlet
