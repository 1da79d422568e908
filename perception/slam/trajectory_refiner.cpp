// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/trajectory_refiner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace swiftlet {
namespace {

constexpr int kIterations = 15;
constexpr int kAlways = 2;  // the next keyframes are partners wherever they are

/// Later keyframes that see what keyframe `i` sees, the likeliest first.
std::vector<int> partners_of(int i, const std::vector<Pose2>& poses, const RefinerParams& params) {
  std::vector<std::pair<double, int>> near;
  const Pose2& here = poses[static_cast<std::size_t>(i)];
  for (int j = i + 1; j < static_cast<int>(poses.size()); ++j) {
    const Pose2& there = poses[static_cast<std::size_t>(j)];
    double apart = (there.position - here.position).norm();
    apart += std::abs(wrap_angle(there.yaw - here.yaw));
    if (j <= i + kAlways) apart = 0.0;
    if (apart <= params.radius) near.emplace_back(apart, j);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > static_cast<std::size_t>(params.partners)) {
    near.resize(static_cast<std::size_t>(params.partners));
  }
  std::vector<int> partners;
  for (const auto& [apart, j] : near) partners.push_back(j);
  return partners;
}

}  // namespace

void refine_poses(const std::vector<KeyframePtr>& keyframes,
                  const std::vector<PoseConstraint>& constraints, std::vector<Pose2>& poses,
                  const RefinerParams& params, const LineMatchNoise& noise) {
  for (int round = 0; round < params.rounds; ++round) {
    std::vector<PoseConstraint> pairs;
    for (int i = 0; i < static_cast<int>(keyframes.size()); ++i) {
      const SurfaceIndex surfaces(keyframes[static_cast<std::size_t>(i)]->points);
      const Pose2 to_i = poses[static_cast<std::size_t>(i)].inverse();
      for (const int j : partners_of(i, poses, params)) {
        const Pose2 guess = to_i * poses[static_cast<std::size_t>(j)];
        const LineMatch match =
            match_lines(surfaces, keyframes[static_cast<std::size_t>(j)]->points, guess);
        const Pose2 moved = guess.inverse() * match.pose;
        if (match.inliers < params.least_inliers || moved.position.norm() > params.most_moved ||
            std::abs(moved.yaw) > params.most_turned) {
          continue;
        }
        pairs.push_back({i, j, match.pose, information_in(match, 0.0, noise), true});
      }
    }
    for (PoseConstraint constraint : constraints) {
      if (constraint.robust) continue;
      constraint.information *= params.kept_share;
      constraint.robust = true;
      pairs.push_back(constraint);
    }
    optimize_poses(poses, pairs, kIterations);
  }
}

}  // namespace swiftlet
