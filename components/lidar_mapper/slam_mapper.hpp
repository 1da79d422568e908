// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "components/runtime/execution/background_work.hpp"
#include "perception/slam/lidar_slam.hpp"
#include "perception/slam/map_joiner.hpp"
#include "perception/slam/scan_map.hpp"

namespace swiftlet {

/// A place that was mapped before.
struct KnownPlace {
  SlamMap map;
  bool stay = false;  ///< find itself in the map and leave it as it is, instead of adding to it
  /// Of the scanner at the first scan, to a metre or two; without it, it is looked for everywhere.
  std::optional<Pose2> first_pose;
};

/// LidarSlam with its back end beside it: poses come at once, closed loops and maps when they are
/// ready. In lockstep everything comes at once.
///
/// In a known place it begins with a map of its own, and looks beside for where that belongs. It
/// looks again, from the beginning, when it has been lost for long in a map that stays as it is.
class SlamMapper {
 public:
  SlamMapper(const LidarSlam::Params& slam, const OccupancyGrid::Params& grid, Mailbox& mailbox,
             const Executor& executor, std::optional<KnownPlace> place = std::nullopt);

  /// `motion` says how the scanner was held and moved, `odometry` where something else thinks that
  /// it was.
  LidarSlam::Update add(Time time, const LaserScan& scan, const ScannerMotion& motion,
                        const std::optional<Pose2>& odometry);

  /// Poses are those in the map; false while it is not yet known where in a known place it is.
  bool located() const { return place_ == nullptr || located_; }
  /// The map as it was last drawn; empty at first. Where it is not located, the known place's.
  const OccupancyGrid& grid() const { return *grid_; }
  const LidarSlam& slam() const { return slam_; }
  /// All that is known by now.
  SlamMap map() const;

 private:
  struct Job {
    LidarSlam::BackEndJob slam;
    std::vector<LevelledScanPtr> scans;
    std::shared_ptr<ScanMap> map;  // none: nothing is drawn
  };
  struct Outcome {
    LidarSlam::BackEndResult slam;
    std::shared_ptr<const OccupancyGrid> grid;  // none: the last one
  };
  struct Arrival {
    std::optional<Pose2> frame;  // T_map_own
    SlamGraph joined;            // where the map is added to
    int own = 0;                 // keyframes
  };
  static Outcome work(const Job& job);
  static Arrival look(const KnownPlace& place, const SlamGraph& own,
                      const LidarSlam::Params& params, bool has_first_pose);
  void begin_job();
  bool begin_looking();
  void arrive(const Arrival& arrival);
  void start_over();
  SlamGraph graph() const;

  LidarSlam::Params params_;
  LidarSlam slam_;
  std::vector<LevelledScanPtr> scans_;  // of the keyframes
  std::shared_ptr<ScanMap> map_;        // the background's while it works
  std::shared_ptr<const OccupancyGrid> grid_;
  std::shared_ptr<const KnownPlace> place_;
  bool located_ = false;
  bool may_use_first_pose_ = true;
  int look_at_ = 1;      // keyframes, for the next look
  int lost_in_row_ = 0;  // scans
  BackgroundWork background_;
};

}  // namespace swiftlet
