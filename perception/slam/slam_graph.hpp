// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "perception/slam/local_map.hpp"
#include "perception/slam/pose_graph.hpp"

namespace swiftlet {

/// What SLAM knows of a place: scans, where they were taken, and what matches said of that.
struct SlamGraph {
  std::vector<KeyframePtr> keyframes;
  std::vector<Pose2> poses;  ///< of the keyframes, in the map
  std::vector<PoseConstraint> constraints;

  int size() const { return static_cast<int>(keyframes.size()); }
};

}  // namespace swiftlet
