// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <optional>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/lidar_mapper/mapper_params.hpp"
#include "components/lidar_mapper/slam_mapper.hpp"
#include "components/static_transforms.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Scans that wait for their pose; more are a sign that odometry has stopped.
constexpr std::size_t kMaxWaiting = 20;
/// A vehicle may stand on the ground, too low to map, for a while.
constexpr int kOutsideToWarn = 300;
constexpr Duration kAlivePeriod = 50ms;  // large maps take their time
constexpr Duration kPathPeriod = 1s;
constexpr double kLongestTurn = 1.0;  // of a scanner that is to be believed [s]
/// Variance of what a planar scanner does not see: height [m^2], roll and pitch [rad^2].
constexpr double kUnseen = 1e6;

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

/// What is left of an attitude without its yaw.
Eigen::Quaterniond levelled(const Eigen::Quaterniond& q) {
  return from_yaw(-yaw_of(q)) * q;
}
Pose2 planar(const PoseHistory::Pose& pose) {
  return {pose.position.head<2>(), yaw_of(pose.attitude)};
}

PoseHistory::Pose operator*(const PoseHistory::Pose& a, const StaticTransforms::Pose& b) {
  return {a.position + a.attitude * b.position, a.attitude * b.attitude};
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
      if (!std::exchange(changed_, false)) return;
      map_.publish(to_msg(slam_ ? slam_->grid() : grid_, now));
    });
    if (params_.slam) begin_slam();
  }

 private:
  void begin_slam() {
    slam_.emplace(params_.lidar_slam, params_.grid, mailbox(), *context().executor);
    lidar_pose_ = advertise(topic::lidar_pose);
    lidar_path_ = advertise(topic::lidar_path);
    every(kPathPeriod, [this](Time now) {
      if (std::exchange(path_changed_, false)) publish_path(now);
    });
  }

  /// Scans whose pose is known by now, or that have to do without, go into the map.
  void insert_waiting() {
    while (!waiting_.empty()) {
      const bool alone = slam_ && poses_.empty();
      if (!alone && (poses_.empty() || stamp(waiting_.front()) > poses_.newest())) return;
      // Odometry of the scanner itself, as in logs of ground robots, needs no mounting.
      const std::string& frame = waiting_.front().header().frame_id();
      const auto mount = mounts_.find(alone ? frame : odometry_frame_, frame);
      if (!mount) return;
      insert(waiting_.front(), *mount);
      waiting_.pop_front();
    }
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
    if (slam_ && mount) {
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
    const auto body = poses_.at(stamp(message), from_seconds(params_.max_odometry_gap));
    if (slam_) {
      locate(message, body, mount);
      return;
    }
    if (!body) return;  // taken before the first odometry, or in a gap of it
    const PoseHistory::Pose scanner = *body * mount;
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

  void locate(const sensor_msgs::msg::LaserScan& message,
              const std::optional<PoseHistory::Pose>& body, const StaticTransforms::Pose& mount) {
    const LaserScan scan = from_msg(message);
    std::optional<Pose2> odometry;
    if (body) {
      const PoseHistory::Pose scanner = *body * mount;
      odometry = planar(scanner);
      motion_ = motion_during(message, scanner, mount);
    } else if (poses_.empty()) {
      motion_.height = 0.5 * (params_.grid.min_height + params_.grid.max_height);
    }
    const LidarSlam::Update update = slam_->add(stamp(message), scan, motion_, odometry);
    if (update.lost && is_worth_a_line(++lost_)) {
      log()->warn("a scan looks like nothing that is known; {} ({} so far)",
                  odometry ? "odometry is followed" : "the last pose is kept", lost_);
    }
    publish_pose(message, update, mount);
    changed_ = path_changed_ = true;
  }

  /// How the scanner was held, and how it moved until the scan was over, by odometry.
  ScannerMotion motion_during(const sensor_msgs::msg::LaserScan& message,
                              const PoseHistory::Pose& scanner,
                              const StaticTransforms::Pose& mount) const {
    ScannerMotion motion;
    motion.q_HL = levelled(scanner.attitude);
    motion.height = scanner.position.z();
    motion.min_height = params_.grid.min_height;
    motion.max_height = params_.grid.max_height;
    const double seconds = static_cast<double>(message.time_increment()) *
                           static_cast<double>(message.ranges().size());
    if (!(seconds > 0.0 && seconds < kLongestTurn)) return motion;
    // What odometry has by now may end before the scan does.
    const Time end = std::min(poses_.newest(), stamp(message) + from_seconds(seconds));
    const auto body = poses_.at(end, from_seconds(params_.max_odometry_gap));
    const double passed = to_seconds(end - stamp(message));
    if (!body || !(passed > 0.0)) return motion;
    const Pose2 moved = planar(scanner).inverse() * planar(*body * mount);
    motion.velocity = moved.position / passed;
    motion.yaw_rate = moved.yaw / passed;
    return motion;
  }

  void publish_pose(const sensor_msgs::msg::LaserScan& scan, const LidarSlam::Update& update,
                    const StaticTransforms::Pose& mount) {
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header(make_header(stamp(scan), frame::kMap));
    const PoseHistory::Pose body = body_at(update.pose, mount);
    message.pose().pose(to_pose(body.position, body.attitude));
    RowMajor6d covariance = kUnseen * RowMajor6d::Identity();
    constexpr int kSeen[] = {0, 1, 5};  // x, y, yaw
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) covariance(kSeen[i], kSeen[j]) = update.covariance(i, j);
    }
    Eigen::Map<RowMajor6d>(message.pose().covariance().data()) = covariance;
    lidar_pose_.publish(message);
    last_mount_ = mount;
  }

  /// Of the body, when the scanner's levelled frame is at `pose`.
  PoseHistory::Pose body_at(const Pose2& pose, const StaticTransforms::Pose& mount) const {
    const Eigen::Quaterniond q_WL = from_yaw(pose.yaw) * motion_.q_HL;
    const Eigen::Quaterniond q_WB = q_WL * mount.attitude.conjugate();
    const Eigen::Vector3d p_WL(pose.position.x(), pose.position.y(), motion_.height);
    return {p_WL - q_WB * mount.position, q_WB};
  }

  void publish_path(Time now) {
    nav_msgs::msg::Path path;
    path.header(make_header(now, frame::kMap));
    for (const LidarSlam::TimedPose& timed : slam_->slam().trajectory()) {
      geometry_msgs::msg::PoseStamped pose;
      pose.header(make_header(timed.time, frame::kMap));
      const PoseHistory::Pose body = body_at(timed.pose, last_mount_);
      pose.pose(to_pose(body.position, body.attitude));
      path.poses().push_back(pose);
    }
    lidar_path_.publish(path);
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
  bool changed_ = false;
  bool path_changed_ = false;
  bool adopted_ = false;  // another instance's map
  int outside_ = 0;       // scans without a beam inside the height band, before the first with one
  ScannerMotion motion_;  // at the last scan
  StaticTransforms::Pose last_mount_;
  Publisher<nav_msgs::msg::OccupancyGrid> map_;
  Publisher<geometry_msgs::msg::PoseWithCovarianceStamped> lidar_pose_;
  Publisher<nav_msgs::msg::Path> lidar_path_;
  std::optional<SlamMapper> slam_;
};

const RegisterComponent<LidarMapper> kRegistered{
    "lidar_mapper", "an occupancy map from scans, at the poses of odometry or of its own"};

}  // namespace
}  // namespace swiftlet
