// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "estimation/geometry/pose2.hpp"
#include "perception/occupancy_grid.hpp"
#include "perception/slam/slam_graph.hpp"

namespace swiftlet {

/// A scan as a map is drawn with it again, wherever it is found to have been taken.
struct LevelledScan {
  LaserScan scan;
  ScannerMotion motion;
};
using LevelledScanPtr = std::shared_ptr<const LevelledScan>;

/// What SLAM knows of a place, and the scans to draw it with: one a keyframe.
struct SlamMap {
  SlamGraph graph;
  std::vector<LevelledScanPtr> scans;
};

/// An occupancy map of scans whose poses are known better and better: those of a pose graph. What
/// is new is added; when a scan has been moved by more than a fraction of a cell, the map is drawn
/// anew.
class ScanMap {
 public:
  explicit ScanMap(const OccupancyGrid::Params& params) : grid_(params) {}

  /// Draws the map of `scans` at `poses` of their levelled frames, one each. Scans that the grid
  /// refuses are left out, and counted.
  void update(const std::vector<LevelledScanPtr>& scans, const std::vector<Pose2>& poses);

  const OccupancyGrid& grid() const { return grid_; }
  int refused() const { return refused_; }
  int redrawn() const { return redrawn_; }  ///< times

 private:
  bool has_moved(const std::vector<Pose2>& poses) const;

  OccupancyGrid grid_;
  std::vector<Pose2> drawn_at_;
  int refused_ = 0;
  int redrawn_ = 0;
};

}  // namespace swiftlet
