// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/loop_closer.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

struct Chain {
  double distance;  // of its nearest keyframe [m]
  int nearest;
};

/// Keyframes that follow each other and are near, as one chain.
std::vector<Chain> chains_near(const std::vector<Pose2>& poses, int newest,
                               const LoopCloserParams& params) {
  constexpr int kGap = 3;  // keyframes outside of the radius that do not end a chain
  std::vector<Chain> chains;
  int last = -kGap - 2;
  const Eigen::Vector2d& here = poses[static_cast<std::size_t>(newest)].position;
  for (int i = 0; i < newest - params.recent; ++i) {
    const double distance = (poses[static_cast<std::size_t>(i)].position - here).norm();
    if (distance > params.radius) continue;
    if (i > last + kGap) {
      chains.push_back({distance, i});
    } else if (distance < chains.back().distance) {
      chains.back() = {distance, i};
    }
    last = i;
  }
  std::sort(chains.begin(), chains.end(),
            [](const Chain& a, const Chain& b) { return a.distance < b.distance; });
  if (chains.size() > static_cast<std::size_t>(params.max_chains)) {
    chains.resize(static_cast<std::size_t>(params.max_chains));
  }
  return chains;
}

bool is_convincing(const ScanMatch& match, const LoopCloserParams& params) {
  if (match.fine.inliers < params.least_inliers || match.fine.rms > params.most_rms) return false;
  return least_known(match.fine).information >= params.least_information;
}

}  // namespace

std::vector<PoseConstraint> close_loops(const std::vector<KeyframePtr>& keyframes,
                                        const std::vector<Pose2>& poses, int newest,
                                        const LoopCloserParams& params,
                                        const LineMatchNoise& noise) {
  std::vector<PoseConstraint> constraints;
  SearchWindow window;
  window.distance = params.distance;
  window.angle = params.angle;
  window.least_score = params.least_score;
  window.distance_penalty = window.angle_penalty = 0.1;
  const Pose2& guess = poses[static_cast<std::size_t>(newest)];
  for (const Chain& chain : chains_near(poses, newest, params)) {
    std::vector<int> which;
    const int last = std::min(newest - params.recent, chain.nearest + params.chain);
    for (int i = std::max(0, chain.nearest - params.chain); i <= last; ++i) which.push_back(i);
    const LocalMap map(keyframes, poses, which);
    const auto match = map.match(*keyframes[static_cast<std::size_t>(newest)], guess, window);
    if (!match || !is_convincing(*match, params)) continue;
    const Pose2& from = poses[static_cast<std::size_t>(chain.nearest)];
    constraints.push_back({chain.nearest, newest, from.inverse() * match->pose(),
                           information_in(match->fine, from.yaw, noise), true});
  }
  return constraints;
}

}  // namespace swiftlet
