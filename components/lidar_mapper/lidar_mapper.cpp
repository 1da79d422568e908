// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <deque>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/static_transforms.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Scans that wait for their pose; more are a sign that odometry has stopped.
constexpr std::size_t kMaxWaiting = 20;
/// A vehicle may stand on the ground, too low to map, for a while.
constexpr int kOutsideToWarn = 300;
constexpr Duration kAlivePeriod = 50ms;  // large maps take their time

struct Params {
  OccupancyGrid::Params grid;
  double map_rate_hz = 5.0;
  double max_odometry_gap = 0.5;  ///< longer ones are not interpolated across [s]
};

Params read_params(const Config& config) {
  Params params;
  // A beam without an echo is as often a dark or slanted wall as open space.
  params.grid.clear_without_return = false;
  config.read("clear_without_return", params.grid.clear_without_return);
  config.read("resolution", params.grid.resolution, {0.005, 1.0});
  config.read("hit_probability", params.grid.hit_probability, {0.51, 0.99});
  config.read("miss_probability", params.grid.miss_probability, {0.01, 0.49});
  config.read("min_height", params.grid.min_height);
  config.read("max_height", params.grid.max_height);
  config.read("max_range", params.grid.max_range, kPositive);
  config.read("map_rate_hz", params.map_rate_hz, {0.1, 50.0});
  config.read("max_odometry_gap", params.max_odometry_gap, kPositive);
  return params;
}

LaserScan from_msg(const sensor_msgs::msg::LaserScan& message) {
  LaserScan scan;
  scan.angle_min = message.angle_min();
  scan.angle_increment = message.angle_increment();
  scan.time_increment = message.time_increment();
  scan.range_min = message.range_min();
  scan.range_max = message.range_max();
  scan.ranges = message.ranges();
  return scan;
}

/// An occupancy map from scans at the poses of odometry, with the scanner where tf_static says that
/// it sits. One that is started beside another begins with the map that is there.
class LidarMapper : public Component {
 public:
  explicit LidarMapper(const ComponentContext& context)
      : Component(context),
        params_(read_params(parameters())),
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
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      const RigidBodyState state = swiftlet::from_msg(odometry);
      poses_.add(swiftlet::from_msg(odometry.header().stamp()), {state.p_WB, state.q_WB});
      odometry_frame_ = odometry.child_frame_id();
      insert_waiting();
    });
    subscribe(topic::tf_static, [this](const tf2_msgs::msg::TFMessage& message) {
      for (const auto& transform : message.transforms()) {
        const Status added = mounts_.add(transform);
        if (!added.ok()) log()->warn("tf_static: {}", added.error().reason);
      }
      insert_waiting();
    });
    subscribe(topic::scan, [this](const sensor_msgs::msg::LaserScan& scan) {
      waiting_.push_back(scan);
      if (waiting_.size() > kMaxWaiting) drop_oldest();
      insert_waiting();
    });
    every(from_seconds(1.0 / params_.map_rate_hz), [this](Time now) {
      if (!std::exchange(changed_, false)) return;
      map_.publish(to_msg(grid_, now));
    });
  }

 private:
  /// Scans whose pose is known by now go into the map.
  void insert_waiting() {
    while (!waiting_.empty() && !poses_.empty() &&
           swiftlet::from_msg(waiting_.front().header().stamp()) <= poses_.newest()) {
      // Odometry of the scanner itself, as in logs of ground robots, needs no mounting.
      const auto mount = mounts_.find(odometry_frame_, waiting_.front().header().frame_id());
      if (!mount) return;
      insert(waiting_.front(), *mount);
      waiting_.pop_front();
    }
  }

  void drop_oldest() {
    const std::string frame = waiting_.front().header().frame_id();
    waiting_.pop_front();
    if (!is_worth_a_line(++dropped_)) return;
    if (poses_.empty() || mounts_.find(odometry_frame_, frame)) {
      log()->warn("a scan was dropped: no odometry at its time ({} so far)", dropped_);
    } else {
      log()->warn(
          "a scan was dropped: nobody says on tf_static where '{}' sits on '{}' ({} so far)", frame,
          odometry_frame_, dropped_);
    }
  }

  void insert(const sensor_msgs::msg::LaserScan& message, const StaticTransforms::Pose& mount) {
    const auto pose = poses_.at(swiftlet::from_msg(message.header().stamp()),
                                from_seconds(params_.max_odometry_gap));
    if (!pose) return;  // taken before the first odometry, or in a gap of it
    const Eigen::Vector3d p_WL = pose->position + pose->attitude * mount.position;
    const auto inserted = grid_.insert(from_msg(message), p_WL, pose->attitude * mount.attitude);
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
          outside_, p_WL.z(), params_.grid.min_height, params_.grid.max_height);
    }
    changed_ = true;
  }

  Params params_;
  OccupancyGrid grid_;
  PoseHistory poses_;
  std::string odometry_frame_;
  StaticTransforms mounts_;
  std::deque<sensor_msgs::msg::LaserScan> waiting_;
  std::uint64_t dropped_ = 0;  // scans without a pose, or without a place on the body
  std::uint64_t refused_ = 0;  // scans that the grid cannot take
  bool changed_ = false;
  bool adopted_ = false;  // another instance's map
  int outside_ = 0;       // scans without a beam inside the height band, before the first with one
  Publisher<nav_msgs::msg::OccupancyGrid> map_;
};

const RegisterComponent<LidarMapper> kRegistered{"lidar_mapper",
                                                 "an occupancy map from scans and odometry"};

}  // namespace
}  // namespace swiftlet
