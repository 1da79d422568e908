// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "perception/voxel_grid.hpp"

namespace swiftlet {

/// From one voxel of a public map to another, with the length of the shortest path that goes from
/// voxel to neighbour, corners not cut.
struct PlanningProblem {
  Voxel start, goal;
  double octile_length = 0.0;  ///< [voxels]
};

/// Where a public map and its problems are.
struct PlanningMapFile {
  std::string name;  ///< X of X.map.gz or X.3dmap.gz
  std::filesystem::path map, problems;
  bool in_space = false;  ///< else in the plane
};

struct PlanningMap {
  VoxelGrid grid;  ///< of depth 1 where the map is one of the plane
  std::vector<PlanningProblem> problems;
};

/// X.map.gz with X.map.scen.gz and X.3dmap.gz with X.3dmap.3dscen.gz in a folder and below, those
/// of the plane first, by name. Maps without problems are left out.
std::vector<PlanningMapFile> find_planning_maps(const std::filesystem::path& folder);

/// Reads a map and the last `most` of its problems, which are the hardest, in the formats of
/// MovingAI (Sturtevant, Benchmarks for grid-based pathfinding, 2012; Brewer and Sturtevant,
/// Benchmarks for pathfinding in 3D voxel space, 2018). Errors name file and line.
Result<PlanningMap> read_planning_map(const PlanningMapFile& file, std::size_t most);

}  // namespace swiftlet
