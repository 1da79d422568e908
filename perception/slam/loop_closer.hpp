// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "perception/slam/local_map.hpp"
#include "perception/slam/pose_graph.hpp"

namespace swiftlet {

struct LoopCloserParams {
  double radius = 4.0;         ///< places that near are looked at again [m]
  int recent = 15;             ///< the last keyframes, which are no loop
  int chain = 7;               ///< keyframes before and after the nearest one that are matched with
  int max_chains = 3;          ///< looked at for one keyframe, the nearest ones
  double distance = 2.0;       ///< searched to either side [m]
  double angle = 0.5;          ///< searched to either side [rad]
  double least_score = 0.5;    ///< of the search
  double least_inliers = 0.7;  ///< of the alignment
  double most_rms = 0.05;      ///< of the alignment [m]
  /// Of the position, in points: below, a corridor that could be matched anywhere along itself.
  double least_information = 5.0;
};

/// Looks whether the place of keyframe `newest` has been seen before: matches it with each chain of
/// older keyframes that passed nearby. What looks the same and is well aligned gives a constraint.
std::vector<PoseConstraint> close_loops(const std::vector<KeyframePtr>& keyframes,
                                        const std::vector<Pose2>& poses, int newest,
                                        const LoopCloserParams& params,
                                        const LineMatchNoise& noise);

}  // namespace swiftlet
