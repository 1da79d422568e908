// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "perception/slam/local_map.hpp"
#include "perception/slam/pose_graph.hpp"

namespace swiftlet {

struct RefinerParams {
  int rounds = 2;
  double radius = 3.0;         ///< keyframes that near see the same [m]
  int partners = 10;           ///< of a keyframe, the nearest ones
  double least_inliers = 0.4;  ///< of a pair
  double most_moved = 0.3;     ///< by the alignment of a pair; more is a mismatch [m]
  double most_turned = 0.1;    ///< the same [rad]
  double kept_share = 0.3;     ///< of the information of the constraints from before
};

/// The last word on a finished log: aligns every keyframe with each of those nearby, pair by pair,
/// and brings all poses into agreement with the pairs and, more weakly, with `odometry` (those of
/// the constraints that join each keyframe with the one before). `poses` must be right to about
/// `most_moved`.
void refine_poses(const std::vector<KeyframePtr>& keyframes,
                  const std::vector<PoseConstraint>& constraints, std::vector<Pose2>& poses,
                  const RefinerParams& params, const LineMatchNoise& noise);

}  // namespace swiftlet
