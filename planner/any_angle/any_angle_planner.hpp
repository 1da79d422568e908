// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "planner/any_angle/taut_line.hpp"
#include "planner/any_angle/voxel_search.hpp"

namespace swiftlet {

/// Short paths of a point among blocked voxels, better with time: steps from voxel to voxel, found
/// greedily, are the first; pulled taut they are the second; a search along lines of sight, pulled
/// taut, is the last.
///
/// Whether there is a path is decided exactly, as far as steps between voxels go: what only leads
/// through the edge or the corner between two blocked voxels is no way.
class AnyAnglePlanner {
 public:
  struct Params {
    double greed = 1.2;  ///< weight of the search for the first path
  };
  enum class End {
    kDone,     ///< there is nothing more to gain
    kStopped,  ///< what was found until then is the result
    kNoPath,
    kStartBlocked,
    kGoalBlocked,
  };
  struct Plan {
    SpaceLine line;       ///< from the middle of the start to that of the goal [voxels]
    double length = 0.0;  ///< [voxels]
    End end = End::kNoPath;
    int expanded = 0;  ///< voxels, in all searches
  };

  /// `grid` must live and stay as it is.
  explicit AnyAnglePlanner(const VoxelGrid& grid);
  AnyAnglePlanner(const VoxelGrid& grid, const Params& params);

  /// `found` gets each path as soon as there is one, each shorter than the last. Only the search
  /// for the first path may have to go through all that can be reached; `stop` ends that, too.
  Plan plan(
      Voxel start, Voxel goal, const Stop& stop,
      const std::function<void(const Plan&)>& found = [](const Plan&) {});

 private:
  const VoxelGrid& grid_;
  Params params_;
  VoxelSearch search_;
};

}  // namespace swiftlet
