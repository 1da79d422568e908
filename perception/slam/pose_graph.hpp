// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/geometry/pose2.hpp"

namespace swiftlet {

/// What a match says: where node `to` is, seen from node `from`.
struct PoseConstraint {
  int from = 0, to = 0;
  Pose2 relative;               ///< T_from_to
  Eigen::Matrix3d information;  ///< of (x, y, yaw) in the frame of `from`
  bool robust = false;          ///< may be wrong: a loop closure
};

struct PoseGraphResult {
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;
};

/// Poses that agree best with all constraints, least squares by Ceres. The first pose stays.
PoseGraphResult optimize_poses(std::vector<Pose2>& poses,
                               const std::vector<PoseConstraint>& constraints,
                               int max_iterations = 20);

}  // namespace swiftlet
