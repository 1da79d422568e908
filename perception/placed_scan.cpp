// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/placed_scan.hpp"

#include <cmath>

namespace swiftlet {
namespace {

constexpr double kLongestTurn = 1.0;  // [s]

Duration between_beams(const LaserScan& scan) {
  const double turn = scan.time_increment * static_cast<double>(scan.ranges.size());
  return turn > 0.0 && turn < kLongestTurn ? from_seconds(scan.time_increment) : Duration(0);
}

}  // namespace

Time end_of(const LaserScan& scan, Time begin) {
  if (scan.ranges.empty()) return begin;
  return begin + between_beams(scan) * static_cast<Duration::rep>(scan.ranges.size() - 1);
}

std::vector<Eigen::Vector3d> placed_returns(const LaserScan& scan, Time begin,
                                            const PoseHistory& body, const PoseHistory::Pose& mount,
                                            Duration max_gap) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(scan.ranges.size());
  const Duration step = between_beams(scan);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range >= scan.range_min && range < scan.range_max)) continue;
    const auto pose = body.at(begin + step * static_cast<Duration::rep>(i), max_gap);
    if (!pose) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d p_L(range * std::cos(angle), range * std::sin(angle), 0.0);
    const Eigen::Vector3d p_W =
        pose->position + pose->attitude * (mount.position + mount.attitude * p_L);
    if (p_W.allFinite()) points.push_back(p_W);
  }
  return points;
}

}  // namespace swiftlet
