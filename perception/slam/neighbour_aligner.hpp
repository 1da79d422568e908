// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "perception/slam/local_map.hpp"
#include "perception/slam/pose_graph.hpp"

namespace swiftlet {

struct NeighbourParams {
  double radius = 3.0;         ///< keyframes that near see the same; a radian counts as a metre [m]
  int most = 10;               ///< neighbours of a keyframe, the nearest ones
  double least_inliers = 0.4;  ///< of a pair
  double most_moved = 0.3;     ///< by the alignment of a pair; more is a mismatch [m]
  double most_turned = 0.1;    ///< the same [rad]
};

/// Aligns keyframe `newest` with each of the earlier ones nearby, pair by pair. Many small
/// agreements hold a map together better than a chain does; they do not close loops, since `poses`
/// must be right to about `most_moved`.
std::vector<PoseConstraint> align_with_neighbours(const std::vector<KeyframePtr>& keyframes,
                                                  const std::vector<Pose2>& poses, int newest,
                                                  const NeighbourParams& params,
                                                  const LineMatchNoise& noise);

}  // namespace swiftlet
