// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/surroundings.hpp"

#include <utility>
#include <vector>

#include "components/conversions.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/surroundings/scan_motion.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kHistory = 2s;
constexpr Duration kMaxGap = 100ms;
/// Beams to either side that see the same surface, nearer to each other than kSameSurface [m].
constexpr std::size_t kBeside = 2;
constexpr double kSameSurface = 0.15;

/// Where the surface is that beam `i` met: the mean of it and of its neighbours, where there are as
/// many to either side. Of many noisy returns the nearest would stop the vehicle too early.
Eigen::Vector2d surface_at(const std::vector<LevelledReturn>& returns, std::size_t i) {
  if (i < kBeside || i + kBeside >= returns.size()) return returns[i].position;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t k = i - kBeside; k <= i + kBeside; ++k) {
    if (returns[k].beam + i != returns[i].beam + k) return returns[i].position;
    if ((returns[k].position - returns[i].position).norm() > kSameSurface) {
      return returns[i].position;
    }
    sum += returns[k].position;
  }
  return sum / (2.0 * kBeside + 1.0);
}

}  // namespace

Surroundings::Surroundings(const Params& params) : params_(params), body_(kHistory) {}

void Surroundings::hear(const nav_msgs::msg::Odometry& odometry) {
  const RigidBodyState state = swiftlet::from_msg(odometry);
  body_.add(swiftlet::from_msg(odometry.header().stamp()), {state.p_WB, state.q_WB});
  body_frame_ = odometry.child_frame_id();
}

void Surroundings::hear(const tf2_msgs::msg::TFMessage& mounts) {
  // What it cannot take is no place of a sensor, and its scans are not placed then.
  for (const auto& transform : mounts.transforms()) (void)mounts_.add(transform);
}

void Surroundings::hear(const sensor_msgs::msg::LaserScan& scan) {
  waiting_ = scan;
}

std::optional<Surroundings::Seen> Surroundings::take() {
  if (!waiting_ || body_.empty()) return std::nullopt;
  const Time time = swiftlet::from_msg(waiting_->header().stamp());
  if (time > body_.newest()) return std::nullopt;
  const sensor_msgs::msg::LaserScan scan = std::move(*waiting_);
  waiting_.reset();
  const auto mount = mounts_.find(body_frame_, scan.header().frame_id());
  const auto body = body_.at(time, kMaxGap);
  if (!mount || !body) return std::nullopt;

  const PoseHistory::Pose scanner = scanner_on(*body, *mount);
  ScannerMotion motion = scanner_motion(scan, scanner, body_, *mount, kMaxGap);
  motion.min_height = params_.min_height;
  motion.max_height = params_.max_height;
  const Pose2 at = planar(scanner);
  const std::vector<LevelledReturn> returns =
      levelled_returns(from_msg(scan), motion, params_.max_range);
  std::vector<Eigen::Vector2d> points;
  points.reserve(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) points.push_back(at * surface_at(returns, i));
  return Seen{time, NearObstacles(std::move(points))};
}

}  // namespace swiftlet
