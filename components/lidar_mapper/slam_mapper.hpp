// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "components/runtime/execution/background_work.hpp"
#include "perception/slam/lidar_slam.hpp"
#include "perception/slam/scan_map.hpp"

namespace swiftlet {

/// LidarSlam with the map that belongs to it. Poses come at once; loops are closed, poses are
/// brought into agreement and the map is drawn in the background.
class SlamMapper {
 public:
  SlamMapper(const LidarSlam::Params& slam, const OccupancyGrid::Params& grid, Mailbox& mailbox,
             const Executor& executor);

  /// `motion` says how the scanner was held and moved, `odometry` where something else thinks that
  /// it was.
  LidarSlam::Update add(Time time, const LaserScan& scan, const ScannerMotion& motion,
                        const std::optional<Pose2>& odometry);

  /// The map as it was last drawn; empty at first.
  const OccupancyGrid& grid() const { return *grid_; }
  const LidarSlam& slam() const { return slam_; }

 private:
  struct Job {
    LidarSlam::BackEndJob slam;
    std::vector<std::shared_ptr<const LevelledScan>> scans;
    std::shared_ptr<ScanMap> map;
  };
  struct Outcome {
    LidarSlam::BackEndResult slam;
    std::shared_ptr<const OccupancyGrid> grid;
  };
  static Outcome work(const Job& job);
  void begin_job();

  LidarSlam slam_;
  std::vector<std::shared_ptr<const LevelledScan>> scans_;  // of the keyframes
  std::shared_ptr<ScanMap> map_;                            // the background's while it works
  std::shared_ptr<const OccupancyGrid> grid_;
  BackgroundWork background_;
};

}  // namespace swiftlet
