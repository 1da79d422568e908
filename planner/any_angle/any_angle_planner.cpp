// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/any_angle/any_angle_planner.hpp"

#include <utility>

namespace swiftlet {

AnyAnglePlanner::AnyAnglePlanner(const VoxelGrid& grid) : AnyAnglePlanner(grid, Params()) {}

AnyAnglePlanner::AnyAnglePlanner(const VoxelGrid& grid, const Params& params)
    : grid_(grid), params_(params), search_(grid) {}

AnyAnglePlanner::Plan AnyAnglePlanner::plan(Voxel start, Voxel goal, const Stop& stop,
                                            const std::function<void(const Plan&)>& found) {
  Plan plan;
  if (!grid_.contains(start) || grid_.blocked(start)) return {{}, 0.0, End::kStartBlocked, 0};
  if (!grid_.contains(goal) || grid_.blocked(goal)) return {{}, 0.0, End::kGoalBlocked, 0};
  const auto search = [&](VoxelSearch::Moves moves, double weight) {
    VoxelSearch::Found result = search_.run(start, goal, moves, weight, stop);
    plan.expanded += result.expanded;
    if (result.end == VoxelSearch::End::kNoPath) plan.end = End::kNoPath;
    if (result.end == VoxelSearch::End::kStopped) plan.end = End::kStopped;
    SpaceLine line;
    for (const Voxel voxel : result.path) line.push_back(center_of(voxel));
    return line;
  };
  const auto take = [&](SpaceLine line) {
    const double length = length_of(line);
    if (line.empty() || (!plan.line.empty() && length >= plan.length)) return;
    plan.line = std::move(line);
    plan.length = length;
    found(plan);
  };
  plan.end = End::kDone;
  take(search(VoxelSearch::Moves::kSteps, params_.greed));
  if (plan.end != End::kDone) return plan;
  take(pull_taut(grid_, plan.line, stop));
  take(pull_taut(grid_, search(VoxelSearch::Moves::kSight, 1.0), stop));
  if (stop()) plan.end = End::kStopped;
  return plan;
}

}  // namespace swiftlet
