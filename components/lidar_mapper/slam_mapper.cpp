// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/slam_mapper.hpp"

#include <utility>

namespace swiftlet {

SlamMapper::SlamMapper(const LidarSlam::Params& slam, const OccupancyGrid::Params& grid,
                       Mailbox& mailbox, const Executor& executor)
    : slam_(slam),
      map_(std::make_shared<ScanMap>(grid)),
      grid_(std::make_shared<const OccupancyGrid>(grid)),
      background_(mailbox, executor) {}

LidarSlam::Update SlamMapper::add(Time time, const LaserScan& scan, const ScannerMotion& motion,
                                  const std::optional<Pose2>& odometry) {
  const LidarSlam::Update update = slam_.add(time, scan_points(scan, motion), odometry);
  if (update.is_keyframe) {
    scans_.push_back(
        std::make_shared<const LevelledScan>(LevelledScan{scan, motion.q_HL, motion.height}));
  }
  begin_job();
  return update;
}

void SlamMapper::begin_job() {
  if (!background_.idle() || !slam_.has_job()) return;
  background_.start([job = Job{slam_.take_job(), scans_, map_}] { return work(job); },
                    [this](Outcome outcome) {
                      slam_.apply(outcome.slam);
                      grid_ = std::move(outcome.grid);
                      begin_job();
                    });
}

SlamMapper::Outcome SlamMapper::work(const Job& job) {
  Outcome outcome;
  outcome.slam = LidarSlam::run_back_end(job.slam);
  job.map->update(job.scans, outcome.slam.poses);
  outcome.grid = std::make_shared<const OccupancyGrid>(job.map->grid());
  return outcome;
}

}  // namespace swiftlet
