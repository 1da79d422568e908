// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <functional>
#include <optional>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/lidar_mapper/map_file.hpp"
#include "components/lidar_mapper/mapper_params.hpp"
#include "components/lidar_mapper/scan_locator.hpp"
#include "components/static_transforms.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/surroundings/scan_motion.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Scans that wait for their pose; more are a sign that odometry has stopped.
constexpr std::size_t kMaxWaiting = 20;
/// A vehicle may stand on the ground, too low to map, for a while.
constexpr int kOutsideToWarn = 300;
constexpr Duration kAlivePeriod = 50ms;  // large maps take their time
constexpr Duration kPathPeriod = 1s;
constexpr Duration kSavePeriod = 60s;

/// A place that was mapped before, as the parameters say. What is wrong with the file is a fault of
/// the configuration.
std::optional<KnownPlace> known_place(const MapperParams& params) {
  if (params.load.empty()) return std::nullopt;
  auto map = load_map_file(params.load);
  if (!map.ok()) throw ConfigError("lidar_mapper.load: " + map.error().reason);
  return KnownPlace{std::move(map).value(), params.stay, params.first_pose};
}

/// An occupancy map from scans, with the scanner where tf_static says that it sits. At the poses of
/// odometry, or, with `slam: true`, at poses that the scans themselves tell; odometry then helps
/// where there is some. One that is started beside another begins with the map that is there.
class LidarMapper : public Component {
 public:
  explicit LidarMapper(const ComponentContext& context)
      : Component(context),
        params_(read_mapper_params(parameters())),
        grid_(params_.grid),
        poses_(std::chrono::seconds(5)) {
    set_alive_period(kAlivePeriod);
    map_ = advertise(topic::map);
    subscribe(
        topic::map,
        [this](const nav_msgs::msg::OccupancyGrid& map) {
          if (active() || std::exchange(adopted_, true)) return;
          grid_ = swiftlet::from_msg(map, params_.grid);
          log()->info("begins with the map of another instance");
        },
        Need::kOptional);
    subscribe(
        topic::odometry,
        [this](const nav_msgs::msg::Odometry& odometry) {
          const RigidBodyState state = swiftlet::from_msg(odometry);
          poses_.add(swiftlet::from_msg(odometry.header().stamp()), {state.p_WB, state.q_WB});
          odometry_frame_ = odometry.child_frame_id();
          insert_waiting();
        },
        params_.slam ? Need::kOptional : Need::kPeriodic);
    subscribe(topic::tf_static, [this](const tf2_msgs::msg::TFMessage& message) {
      for (const auto& transform : message.transforms()) {
        const Status added = mounts_.add(transform);
        if (!added.ok()) log()->warn("tf_static: {}", added.error().reason);
      }
      insert_waiting();
    });
    subscribe(topic::scan, [this](const sensor_msgs::msg::LaserScan& scan) {
      waiting_.push_back(scan);
      if (waiting_.size() > kMaxWaiting) give_up_waiting();
      insert_waiting();
    });
    every(from_seconds(1.0 / params_.map_rate_hz), [this](Time now) {
      const OccupancyGrid& grid = locator_ ? locator_->slam().grid() : grid_;
      if (grid.empty() || !std::exchange(changed_, false)) return;
      map_.publish(to_msg(grid, now));
    });
    if (params_.slam) begin_slam();
  }
  ~LidarMapper() override {
    if (params_.save.empty()) return;
    saving_.reset();  // waits for what is under way
    if (worth_saving_) report(saver()());
  }

 private:
  void begin_slam() {
    locator_.emplace(params_, mailbox(), *context().executor, known_place(params_));
    changed_ = !params_.load.empty();
    lidar_pose_ = advertise(topic::lidar_pose);
    lidar_path_ = advertise(topic::lidar_path);
    every(kPathPeriod, [this](Time now) {
      if (std::exchange(path_changed_, false)) lidar_path_.publish(locator_->path(now));
    });
    if (params_.save.empty()) return;
    saving_.emplace(mailbox(), *context().executor);
    every(kSavePeriod, [this](Time) {
      if (!saving_->idle() || !std::exchange(worth_saving_, false)) return;
      saving_->start(saver(), [this](const Status& saved) { report(saved); });
    });
  }

  /// What is known now, ready to be written beside the callbacks: poses do not wait for a disk.
  std::function<Status()> saver() {
    const SlamMapper& slam = locator_->slam();
    return [map = slam.map(), grid = slam.grid(), time = now(), file = params_.save] {
      return save_map_file(map, grid, time, file);
    };
  }
  void report(const Status& saved) {
    if (!saved.ok()) log()->error("the map is not saved: {}", saved.error().reason);
  }

  /// Scans whose pose is known by now, or that have to do without, go into the map.
  void insert_waiting() {
    while (!waiting_.empty()) {
      const bool known = !poses_.empty() && stamp(waiting_.front()) <= poses_.newest();
      if (!known && !goes_alone()) return;
      const bool was_alone = std::exchange(alone_, !known);
      if (alone_ && !was_alone && !poses_.empty()) {
        log()->warn("odometry fell silent: poses are found without it");
      }
      // Odometry of the scanner itself, as in logs of ground robots, needs no mounting.
      const std::string& frame = waiting_.front().header().frame_id();
      const auto mount = mounts_.find(poses_.empty() ? frame : odometry_frame_, frame);
      if (!mount) return;
      insert(waiting_.front(), *mount);
      waiting_.pop_front();
    }
  }

  /// Whether it finds its poses itself and has no odometry, or none for so long that scans do not
  /// wait for it.
  bool goes_alone() const {
    if (!locator_) return false;
    return poses_.empty() ||
           stamp(waiting_.back()) - poses_.newest() > from_seconds(params_.max_odometry_gap);
  }

  static Time stamp(const sensor_msgs::msg::LaserScan& scan) {
    return swiftlet::from_msg(scan.header().stamp());
  }

  void give_up_waiting() {
    const sensor_msgs::msg::LaserScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    const std::string& frame = scan.header().frame_id();
    const auto mount = mounts_.find(odometry_frame_, frame);
    const bool worth_a_line = is_worth_a_line(++dropped_);
    if (locator_ && mount) {
      if (worth_a_line) log()->warn("no odometry at the time of {} scans so far", dropped_);
      insert(scan, *mount);
    } else if (worth_a_line && (poses_.empty() || mount)) {
      log()->warn("a scan was dropped: no odometry at its time ({} so far)", dropped_);
    } else if (worth_a_line) {
      log()->warn(
          "a scan was dropped: nobody says on tf_static where '{}' sits on '{}' ({} so far)", frame,
          odometry_frame_, dropped_);
    }
  }

  void insert(const sensor_msgs::msg::LaserScan& message, const StaticTransforms::Pose& mount) {
    if (locator_) {
      locate(message, mount);
      return;
    }
    const auto body = poses_.at(stamp(message), from_seconds(params_.max_odometry_gap));
    if (!body) return;  // taken before the first odometry, or in a gap of it
    const PoseHistory::Pose scanner = scanner_on(*body, mount);
    const auto inserted = grid_.insert(from_msg(message), scanner.position, scanner.attitude);
    if (!inserted.ok()) {
      if (is_worth_a_line(++refused_)) {
        log()->warn("scan refused: {} ({} so far)", inserted.error().reason, refused_);
      }
      return;
    }
    const bool all_outside = inserted->returns == 0 && inserted->clearing == 0;
    if (all_outside && grid_.empty() && ++outside_ == kOutsideToWarn) {
      log()->warn(
          "{} scans at {:.2f} m are wholly outside of the heights that are mapped ({:.2f} to "
          "{:.2f} m); see the parameters min_height and max_height",
          outside_, scanner.position.z(), params_.grid.min_height, params_.grid.max_height);
    }
    changed_ = true;
  }

  void locate(const sensor_msgs::msg::LaserScan& scan, const StaticTransforms::Pose& mount) {
    const bool was_located = locator_->slam().located();
    const auto pose = locator_->locate(scan, poses_, mount);
    if (locator_->lost() && is_worth_a_line(++lost_)) {
      log()->warn("a scan looks like nothing that is known; {} ({} so far)",
                  alone_ ? "the last pose is kept" : "odometry is followed", lost_);
    }
    const bool located = locator_->slam().located();
    if (located != was_located) {
      log()->info("{}", located ? "found itself in the map that was loaded"
                                : "lost in the map that was loaded; looks everywhere");
    }
    // The first pose after it was found is still one of its own map.
    if (was_located && located) lidar_pose_.publish(pose);
    changed_ = path_changed_ = worth_saving_ = true;
  }

  MapperParams params_;
  OccupancyGrid grid_;
  PoseHistory poses_;
  std::string odometry_frame_;
  StaticTransforms mounts_;
  std::deque<sensor_msgs::msg::LaserScan> waiting_;
  std::uint64_t dropped_ = 0;  // scans without a pose, or without a place on the body
  std::uint64_t refused_ = 0;  // scans that the grid cannot take
  std::uint64_t lost_ = 0;     // scans that could not be matched
  bool alone_ = false;         // scans go in without odometry
  bool changed_ = false;
  bool path_changed_ = false;
  bool adopted_ = false;  // another instance's map
  int outside_ = 0;       // scans without a beam inside the height band, before the first with one
  Publisher<nav_msgs::msg::OccupancyGrid> map_;
  Publisher<geometry_msgs::msg::PoseWithCovarianceStamped> lidar_pose_;
  Publisher<nav_msgs::msg::Path> lidar_path_;
  std::optional<ScanLocator> locator_;
  bool worth_saving_ = false;
  std::optional<BackgroundWork> saving_;
};

const RegisterComponent<LidarMapper> kRegistered{
    "lidar_mapper", "an occupancy map from scans, at the poses of odometry or of its own"};

}  // namespace
}  // namespace swiftlet
