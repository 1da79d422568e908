// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/cloud_collector.hpp"

#include <utility>

#include "components/conversions.hpp"
#include "components/surroundings/cloud_message.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/topics.hpp"
#include "perception/placed_scan.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kHistory = 5s;
/// Of odometry, which a radio link may thin.
constexpr Duration kMaxGap = 300ms;
constexpr std::size_t kMostWaiting = 50;

}  // namespace

CloudCollector::CloudCollector(double voxel) : cloud_(voxel), body_(kHistory) {}

void CloudCollector::hear(const nav_msgs::msg::Odometry& odometry) {
  const RigidBodyState state = swiftlet::from_msg(odometry);
  if (!state.p_WB.allFinite() || !state.q_WB.coeffs().allFinite()) return;
  body_.add(swiftlet::from_msg(odometry.header().stamp()), {state.p_WB, state.q_WB});
  body_frame_ = odometry.child_frame_id();
  place_waiting();
}

void CloudCollector::hear(const tf2_msgs::msg::TFMessage& mounts) {
  // What it cannot take is no place of a sensor, and its scans are not placed then.
  for (const auto& transform : mounts.transforms()) (void)mounts_.add(transform);
}

void CloudCollector::hear(const sensor_msgs::msg::LaserScan& scan) {
  ++heard_;
  const Time begin = swiftlet::from_msg(scan.header().stamp());
  wait({begin, end_of(from_msg(scan), begin), scan.header().frame_id(), scan, {}});
}

void CloudCollector::hear(const sensor_msgs::msg::PointCloud2& cloud) {
  ++heard_;
  auto points = points_of(cloud);
  if (!points.ok()) {
    problem_ = "a cloud cannot be read: " + points.error().reason;
    return;
  }
  if (cloud.header().frame_id() == frame::kMap) return take(*points);
  const Time time = swiftlet::from_msg(cloud.header().stamp());
  wait({time, time, cloud.header().frame_id(), {}, std::move(*points)});
}

void CloudCollector::wait(Waiting waiting) {
  waiting_.push_back(std::move(waiting));
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
  place_waiting();
}

void CloudCollector::place_waiting() {
  while (!waiting_.empty() && !body_.empty() && waiting_.front().end <= body_.newest()) {
    place(waiting_.front());
    waiting_.pop_front();
  }
}

void CloudCollector::place(const Waiting& waiting) {
  const auto mount = mounts_.find(body_frame_, waiting.frame);
  if (!mount) {
    problem_ = "where the sensor '" + waiting.frame + "' sits on '" + body_frame_ +
               "' is not known: nothing of it is heard on tf_static";
    return;
  }
  const auto body = body_.at(waiting.begin, kMaxGap);
  if (!body) {
    problem_ = "there is no odometry of the time at which it was taken; do the clocks agree?";
    return;
  }
  if (waiting.points.empty()) {
    return take(placed_returns(from_msg(waiting.scan), waiting.begin, body_, *mount, kMaxGap));
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(waiting.points.size());
  for (const Eigen::Vector3d& point : waiting.points) {
    points.emplace_back(body->position +
                        body->attitude * (mount->position + mount->attitude * point));
  }
  take(points);
}

void CloudCollector::take(const std::vector<Eigen::Vector3d>& points) {
  ++placed_;
  for (const Eigen::Vector3d& point : points) (void)cloud_.add(point);
}

std::string CloudCollector::problem() const {
  if (!problem_.empty()) return problem_;
  if (body_.empty()) return "no odometry is heard, so where it was taken is not known";
  if (heard_ > placed_) return "odometry of the time at which it was taken has not come yet";
  return "nothing was in reach";
}

}  // namespace swiftlet
