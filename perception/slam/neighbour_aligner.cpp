// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/neighbour_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace swiftlet {
namespace {

constexpr int kAlways = 2;  // the last keyframes are neighbours wherever they are

/// Earlier keyframes that see what `newest` sees, the likeliest first.
std::vector<int> neighbours_of(int newest, const std::vector<Pose2>& poses,
                               const NeighbourParams& params) {
  std::vector<std::pair<double, int>> near;
  const Pose2& here = poses[static_cast<std::size_t>(newest)];
  for (int i = 0; i < newest; ++i) {
    const Pose2& there = poses[static_cast<std::size_t>(i)];
    double apart = (there.position - here.position).norm();
    apart += std::abs(wrap_angle(there.yaw - here.yaw));
    if (i >= newest - kAlways) apart = 0.0;
    if (apart <= params.radius) near.emplace_back(apart, i);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > static_cast<std::size_t>(params.most)) {
    near.resize(static_cast<std::size_t>(params.most));
  }
  std::vector<int> neighbours;
  for (const auto& [apart, i] : near) neighbours.push_back(i);
  return neighbours;
}

}  // namespace

std::vector<PoseConstraint> align_with_neighbours(const std::vector<KeyframePtr>& keyframes,
                                                  const std::vector<Pose2>& poses, int newest,
                                                  const NeighbourParams& params,
                                                  const LineMatchNoise& noise) {
  std::vector<PoseConstraint> constraints;
  const SurfaceIndex surfaces(keyframes[static_cast<std::size_t>(newest)]->points);
  const Pose2 to_newest = poses[static_cast<std::size_t>(newest)].inverse();
  for (const int i : neighbours_of(newest, poses, params)) {
    const Pose2 guess = to_newest * poses[static_cast<std::size_t>(i)];
    const LineMatch match =
        match_lines(surfaces, keyframes[static_cast<std::size_t>(i)]->points, guess);
    const Pose2 moved = guess.inverse() * match.pose;
    if (match.inliers < params.least_inliers || moved.position.norm() > params.most_moved ||
        std::abs(moved.yaw) > params.most_turned) {
      continue;
    }
    constraints.push_back({newest, i, match.pose, information_in(match, 0.0, noise), true});
  }
  return constraints;
}

}  // namespace swiftlet
