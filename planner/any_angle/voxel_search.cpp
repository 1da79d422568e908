// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/any_angle/voxel_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace swiftlet {
namespace {

constexpr int kStepsPerStopCheck = 256;

/// Which of the 27 voxels around (and at) one is meant, each axis -1, 0 or 1.
constexpr int bit_of(int x, int y, int z) {
  return (x + 1) + 3 * (y + 1) + 9 * (z + 1);
}

float distance(Voxel a, Voxel b) {
  const auto x = static_cast<float>(a.x - b.x), y = static_cast<float>(a.y - b.y),
             z = static_cast<float>(a.z - b.z);
  return std::sqrt(x * x + y * y + z * z);
}

/// Of the shortest steps where nothing is in the way.
float distance_in_steps(Voxel a, Voxel b) {
  int x = std::abs(a.x - b.x), y = std::abs(a.y - b.y), z = std::abs(a.z - b.z);
  if (x < y) std::swap(x, y);
  if (y < z) std::swap(y, z);
  if (x < y) std::swap(x, y);
  constexpr float kRoot2 = 1.41421356F, kRoot3 = 1.73205081F;
  return static_cast<float>(x - y) + kRoot2 * static_cast<float>(y - z) +
         kRoot3 * static_cast<float>(z);
}

Voxel operator+(Voxel a, Voxel b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

}  // namespace

VoxelSearch::VoxelSearch(const VoxelGrid& grid) : grid_(grid), nodes_(grid.stored()) {
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        if (z != 0 && grid.size_z() == 1) continue;  // a map of the plane
        Step step{
            {x, y, z}, x + y * grid.stride(1) + z * grid.stride(2), distance({}, {x, y, z}), 0};
        for (int k = std::min(z, 0); k <= std::max(z, 0); ++k) {
          for (int j = std::min(y, 0); j <= std::max(y, 0); ++j) {
            for (int i = std::min(x, 0); i <= std::max(x, 0); ++i) {
              step.needs |= 1U << bit_of(i, j, k);
            }
          }
        }
        steps_.push_back(step);
      }
    }
  }
}

std::uint32_t VoxelSearch::free_around(std::int32_t node) const {
  std::uint32_t free = 0;
  int bit = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      const std::int32_t row = node + y * grid_.stride(1) + z * grid_.stride(2);
      for (int x = -1; x <= 1; ++x, ++bit) {
        if (!grid_.blocked(at(row + x))) free |= 1U << bit;
      }
    }
  }
  return free;
}

void VoxelSearch::reset() {
  if (run_ >= std::numeric_limits<std::uint32_t>::max() / 2 - 1) {
    std::fill(nodes_.begin(), nodes_.end(), Node{});
    run_ = 0;
  }
  ++run_;
  open_.clear();
}

/// A node was taken to be seen from its parent. Where it is not, it is a step from the best of
/// those around it that are expanded, of which its parent's child is one.
void VoxelSearch::see_or_step(std::int32_t node, std::uint32_t free) {
  Node& here = nodes_[at(node)];
  if (sees(grid_, grid_.voxel_at(at(node)), grid_.voxel_at(at(here.parent)))) return;
  here.length = std::numeric_limits<float>::infinity();
  for (const Step& step : steps_) {
    const std::int32_t from = node + step.offset;
    if ((step.needs & ~free) != 0 || !expanded(from)) continue;
    const float length = nodes_[at(from)].length + step.length;
    if (length >= here.length) continue;
    here.length = length;
    here.parent = from;
  }
}

VoxelSearch::Found VoxelSearch::run(Voxel start, Voxel goal, Moves moves, double weight,
                                    const Stop& stop) {
  Found result;
  if (!grid_.contains(start) || !grid_.contains(goal) || grid_.blocked(start) ||
      grid_.blocked(goal)) {
    return result;
  }
  reset();
  const auto from = static_cast<std::int32_t>(grid_.index(start)),
             to = static_cast<std::int32_t>(grid_.index(goal));
  const auto greed = static_cast<float>(weight);
  const auto dearer = [](const Open& a, const Open& b) { return a.cost > b.cost; };
  const auto push = [&](std::int32_t node, Voxel voxel) {
    const float rest =
        moves == Moves::kSight ? distance(voxel, goal) : distance_in_steps(voxel, goal);
    open_.push_back({nodes_[at(node)].length + greed * rest, node});
    std::push_heap(open_.begin(), open_.end(), dearer);
  };
  nodes_[at(from)] = {0.0F, from, 2 * run_};
  push(from, start);
  while (!open_.empty()) {
    const std::int32_t node = open_.front().node;
    std::pop_heap(open_.begin(), open_.end(), dearer);
    open_.pop_back();
    if (expanded(node)) continue;  // was cheaper before
    if (++result.expanded % kStepsPerStopCheck == 0 && stop()) {
      result.end = End::kStopped;
      return result;
    }
    const std::uint32_t free = free_around(node);
    if (moves == Moves::kSight) see_or_step(node, free);
    nodes_[at(node)].visit = 2 * run_ + 1;
    if (node == to) break;
    const std::int32_t parent = moves == Moves::kSight ? nodes_[at(node)].parent : node;
    const float length = nodes_[at(parent)].length;
    const Voxel here = grid_.voxel_at(at(node)), last_turn = grid_.voxel_at(at(parent));
    for (const Step& step : steps_) {
      if ((step.needs & ~free) != 0) continue;
      const std::int32_t next = node + step.offset;
      if (expanded(next)) continue;
      const Voxel voxel = here + step.by;
      const float through = length + distance(last_turn, voxel);
      if (visited(next) && through >= nodes_[at(next)].length) continue;
      nodes_[at(next)] = {through, parent, 2 * run_};
      push(next, voxel);
    }
  }
  if (!expanded(to)) return result;
  result.end = End::kFound;
  result.path = path_to(to, start);
  return result;
}

std::vector<Voxel> VoxelSearch::path_to(std::int32_t goal, Voxel start) const {
  std::vector<Voxel> path{grid_.voxel_at(at(goal))};
  std::int32_t way = 0;  // of the last step, in the memory of the grid
  for (std::int32_t node = goal; path.back() != start;) {
    const std::int32_t parent = nodes_[at(node)].parent;
    const bool goes_on = path.size() > 1 && parent - node == way;
    way = parent - node;
    node = parent;
    if (goes_on) path.pop_back();
    path.push_back(grid_.voxel_at(at(node)));
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace swiftlet
