// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/geometry/pose2.hpp"

namespace swiftlet {

/// Where a vehicle was, on the clock of its log.
struct TimedPose2 {
  double t = 0.0;  ///< [s]
  Pose2 pose;
};

/// That the pose at `to` is `relative`, seen from the one at `from`: verified by a person.
struct PoseRelation {
  double from = 0.0, to = 0.0;  ///< [s]
  Pose2 relative;
};

/// How far a trajectory is from what relations say.
struct RelationErrors {
  std::size_t count = 0;  ///< relations within the time of the trajectory
  double translation_mean = 0.0, translation_std = 0.0;  ///< [m]
  double rotation_mean = 0.0, rotation_std = 0.0;        ///< [rad]
};

/// Reads lines `from to dx dy dz roll pitch yaw`. Errors name file and line.
Result<std::vector<PoseRelation>> read_relations(const std::filesystem::path& file);

/// The metric of Kuemmerle et al., On measuring the accuracy of SLAM algorithms, 2009, equations 4
/// and 5: mean and standard deviation over all relations of the length and of the turn of
/// (estimated relative pose)^-1 (true one). Poses between those of the trajectory, which is in the
/// order of time, are interpolated.
RelationErrors relation_errors(const std::vector<TimedPose2>& trajectory,
                               const std::vector<PoseRelation>& relations);

}  // namespace swiftlet
