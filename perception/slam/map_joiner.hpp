// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "perception/slam/loop_closer.hpp"
#include "perception/slam/neighbour_aligner.hpp"
#include "perception/slam/slam_graph.hpp"

namespace swiftlet {

struct FrameSearchParams {
  int places = 12;              ///< of the other map that are looked for, spread over it
  int patch = 3;                ///< keyframes before and after a place that are looked for with it
  double patch_radius = 4.0;    ///< of them, those that near [m]
  double least_score = 0.55;    ///< of a search
  double least_inliers = 0.6;   ///< of an alignment
  double agree_distance = 0.5;  ///< two places that say the same are that near [m]
  double agree_angle = 0.1;     ///< and turned by no more [rad]
  int least_votes = 3;          ///< places that must say the same
  double clear_majority = 2.0;  ///< times the votes of the next best answer
};

/// Where the frame of `other` is in that of `map`, T_map_other, when nothing is known of it: places
/// of the other are searched for in all of the map, and what most of them say is the answer.
/// Nothing where too few agree: the two do not overlap, or look the same in several ways.
std::optional<Pose2> find_frame(const SlamGraph& map, const SlamGraph& other,
                                const FrameSearchParams& params = {});

/// The same, when it is known to about `distance` and `angle`: one place is enough.
std::optional<Pose2> refine_frame(const SlamGraph& map, const SlamGraph& other, const Pose2& guess,
                                  double distance, double angle,
                                  const FrameSearchParams& params = {});

struct JoinParams {
  LoopCloserParams loops;
  NeighbourParams neighbours;
  LineMatchNoise noise;
  int iterations = 20;
};

/// Both maps as one, in the frame of `map`: its keyframes first. Wherever the other passed what the
/// first knows, they are matched; then all poses are brought into agreement.
SlamGraph join_maps(const SlamGraph& map, const SlamGraph& other, const Pose2& T_map_other,
                    const JoinParams& params = {});

}  // namespace swiftlet
