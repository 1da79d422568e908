// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/slam_mapper.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {
namespace {

constexpr int kFirstLook = 3;       // keyframes, without a first pose
constexpr double kLookAgain = 1.3;  // times as many, for the next look
constexpr int kLongLost = 40;       // scans in a row
// How far off a first pose may be [m], [rad].
constexpr double kFirstDistance = 2.0, kFirstAngle = 0.6;

std::shared_ptr<const OccupancyGrid> drawn(const SlamMap& map,
                                           const OccupancyGrid::Params& params) {
  ScanMap drawing(params);
  drawing.update(map.scans, map.graph.poses);
  return std::make_shared<const OccupancyGrid>(drawing.grid());
}

}  // namespace

SlamMapper::SlamMapper(const LidarSlam::Params& slam, const OccupancyGrid::Params& grid,
                       Mailbox& mailbox, const Executor& executor, std::optional<KnownPlace> place)
    : params_(slam),
      slam_(slam),
      map_(std::make_shared<ScanMap>(grid)),
      grid_(std::make_shared<const OccupancyGrid>(grid)),
      background_(mailbox, executor) {
  if (!place) return;
  place_ = std::make_shared<const KnownPlace>(*std::move(place));
  grid_ = drawn(place_->map, grid);
}

LidarSlam::Update SlamMapper::add(Time time, const LaserScan& scan, const ScannerMotion& motion,
                                  const std::optional<Pose2>& odometry) {
  const LidarSlam::Update update = slam_.add(time, scan_points(scan, motion), odometry);
  if (update.is_keyframe) {
    scans_.push_back(std::make_shared<const LevelledScan>(LevelledScan{scan, motion}));
  }
  lost_in_row_ = update.lost ? lost_in_row_ + 1 : 0;
  if (place_ != nullptr && place_->stay && located_ && lost_in_row_ >= kLongLost) start_over();
  begin_job();
  return update;
}

SlamGraph SlamMapper::graph() const {
  return {slam_.keyframes(), slam_.poses(), slam_.constraints()};
}

SlamMap SlamMapper::map() const {
  return located() ? SlamMap{graph(), scans_} : place_->map;
}

void SlamMapper::begin_job() {
  if (!background_.idle() || begin_looking() || !slam_.has_job()) return;
  background_.start(
      [job = Job{slam_.take_job(), scans_, located() ? map_ : nullptr}] { return work(job); },
      [this](Outcome outcome) {
        slam_.apply(outcome.slam);
        if (outcome.grid != nullptr) grid_ = std::move(outcome.grid);
        begin_job();
      });
}

SlamMapper::Outcome SlamMapper::work(const Job& job) {
  Outcome outcome;
  outcome.slam = LidarSlam::run_back_end(job.slam);
  if (job.map == nullptr) return outcome;
  job.map->update(job.scans, outcome.slam.poses);
  outcome.grid = std::make_shared<const OccupancyGrid>(job.map->grid());
  return outcome;
}

bool SlamMapper::begin_looking() {
  if (located() || slam_.has_job()) return false;
  const int keyframes = static_cast<int>(slam_.keyframes().size());
  const bool has_first_pose = place_->first_pose && may_use_first_pose_;
  if (keyframes < std::max(look_at_, has_first_pose ? 1 : kFirstLook)) return false;
  look_at_ = std::max(keyframes + 1, static_cast<int>(kLookAgain * keyframes));
  background_.start([place = place_, own = graph(), params = params_,
                     has_first_pose] { return look(*place, own, params, has_first_pose); },
                    [this](const Arrival& arrival) {
                      if (arrival.frame) arrive(arrival);
                      begin_job();
                    });
  return true;
}

SlamMapper::Arrival SlamMapper::look(const KnownPlace& place, const SlamGraph& own,
                                     const LidarSlam::Params& params, bool has_first_pose) {
  Arrival arrival;
  arrival.own = own.size();
  arrival.frame = has_first_pose ? refine_frame(place.map.graph, own,
                                                *place.first_pose * own.poses.front().inverse(),
                                                kFirstDistance, kFirstAngle)
                                 : find_frame(place.map.graph, own);
  if (!arrival.frame || place.stay) return arrival;
  JoinParams join;
  join.loops = params.loops;
  join.neighbours = params.neighbours;
  join.noise = params.noise;
  arrival.joined = join_maps(place.map.graph, own, *arrival.frame, join);
  return arrival;
}

void SlamMapper::arrive(const Arrival& arrival) {
  located_ = true;
  if (place_->stay) {
    slam_.stay_in(place_->map.graph, *arrival.frame);
    scans_ = place_->map.scans;
    return;
  }
  slam_.enter(arrival.joined, arrival.own);
  scans_.insert(scans_.begin(), place_->map.scans.begin(), place_->map.scans.end());
}

void SlamMapper::start_over() {
  slam_ = LidarSlam(params_);
  scans_.clear();
  located_ = may_use_first_pose_ = false;
  look_at_ = 1;
  lost_in_row_ = 0;
}

}  // namespace swiftlet
