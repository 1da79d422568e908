// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "perception/voxel_grid.hpp"
#include "planner/any_angle/stop.hpp"

namespace swiftlet {

/// Searches from the middle of one free voxel to that of another, over the 26 voxels around each; a
/// step past an edge or a corner needs all voxels there to be free.
///
/// Keeps its memory (12 bytes a voxel) from one search to the next, so that a search costs what it
/// visits and not what the map is large.
class VoxelSearch {
 public:
  enum class Moves {
    kSteps,  ///< from a voxel to one beside it: A*
    /// From a voxel to any that it sees: Nash, Koenig and Tovey, Lazy Theta*: any-angle path
    /// planning and path length analysis in 3D, AAAI 2010.
    kSight,
  };
  enum class End { kFound, kNoPath, kStopped };
  struct Found {
    End end = End::kNoPath;
    std::vector<Voxel> path;  ///< start, where it turns, goal
    int expanded = 0;
  };

  /// `grid` must live and stay as it is.
  explicit VoxelSearch(const VoxelGrid& grid);

  /// From `start` to `goal`, both inside and free. With `weight` 1 paths are the shortest that the
  /// moves make; a larger one makes the search greedy, and paths at most about so much longer.
  Found run(Voxel start, Voxel goal, Moves moves, double weight, const Stop& stop);

 private:
  struct Node {
    float length = 0.0F;  // from the start
    std::int32_t parent = 0;
    std::uint32_t visit = 0;  // twice the run it belongs to, plus one once it is expanded
  };
  struct Open {
    float cost;
    std::int32_t node;
  };
  struct Step {
    Voxel by;
    std::int32_t offset = 0;  // in the memory of the grid
    float length = 0.0F;
    std::uint32_t needs = 0;  // of the 27 voxels around, those that must be free
  };

  void reset();
  std::vector<Voxel> path_to(std::int32_t goal, Voxel start) const;
  std::uint32_t free_around(std::int32_t node) const;
  void see_or_step(std::int32_t node, std::uint32_t free);
  bool expanded(std::int32_t node) const { return nodes_[at(node)].visit == 2 * run_ + 1; }
  bool visited(std::int32_t node) const { return nodes_[at(node)].visit / 2 == run_; }
  static std::size_t at(std::int32_t node) { return static_cast<std::size_t>(node); }

  const VoxelGrid& grid_;
  std::vector<Step> steps_;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  std::uint32_t run_ = 0;
};

}  // namespace swiftlet
