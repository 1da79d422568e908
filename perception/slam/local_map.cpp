// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/local_map.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {
namespace {

constexpr std::size_t kSparsePoints = 120;

std::vector<Eigen::Vector2d> positions(const ScanPoints& points) {
  std::vector<Eigen::Vector2d> result;
  result.reserve(points.size());
  for (const SurfacePoint& p : points) result.push_back(p.position);
  return result;
}

}  // namespace

Keyframe make_keyframe(Time time, ScanPoints points, const std::optional<Pose2>& odometry) {
  Keyframe keyframe{time, std::move(points), {}, odometry};
  const double step =
      std::max(1.0, static_cast<double>(keyframe.points.size()) / double{kSparsePoints});
  for (double i = 0.0; i < static_cast<double>(keyframe.points.size()); i += step) {
    keyframe.sparse.push_back(keyframe.points[static_cast<std::size_t>(i)].position);
  }
  return keyframe;
}

ScanPoints surfaces_of(const std::vector<KeyframePtr>& keyframes, const std::vector<Pose2>& poses,
                       const std::vector<int>& which) {
  ScanPoints all;
  for (const int i : which) {
    const Pose2& pose = poses[static_cast<std::size_t>(i)];
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(pose.yaw).toRotationMatrix();
    for (const SurfacePoint& p : keyframes[static_cast<std::size_t>(i)]->points) {
      all.push_back({pose.position + R * p.position, R * p.normal});
    }
  }
  return all;
}

LocalMap::LocalMap(const std::vector<KeyframePtr>& keyframes, const std::vector<Pose2>& poses,
                   const std::vector<int>& which)
    : LocalMap(surfaces_of(keyframes, poses, which)) {}

LocalMap::LocalMap(ScanPoints points)
    : field_(positions(points), LikelihoodField::Params{}), surfaces_(std::move(points)) {}

std::optional<ScanMatch> LocalMap::match(const Keyframe& scan, const Pose2& guess,
                                         const SearchWindow& window,
                                         const std::optional<PosePrior>& prior) const {
  const auto coarse = find_best_match(field_, scan.sparse, guess, window);
  if (!coarse) return std::nullopt;
  return ScanMatch{coarse->score, align(scan, coarse->pose, prior)};
}

}  // namespace swiftlet
