// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "components/static_transforms.hpp"
#include "components/surroundings/scan_message.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/component_bench.hpp"
#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {

using namespace std::chrono_literals;

inline constexpr double kSpeed = 0.5;  // [m/s]

/// Flies along the lower corridor of office_floor(), without odometry unless it is asked for.
struct SlamBench : Bench {
  std::vector<geometry_msgs::msg::PoseWithCovarianceStamped>& poses = record(topic::lidar_pose);
  std::vector<nav_msgs::msg::Path>& paths = record(topic::lidar_path);
  std::vector<nav_msgs::msg::OccupancyGrid>& maps = record(topic::map);

  /// `parameters`: besides those that every one has. `since`: how far along the corridor it begins.
  explicit SlamBench(const std::string& parameters = "", Duration since = Duration::zero())
      : Bench("lidar_mapper", "{slam: true, min_height: 0.0" + parameters + "}"), since_(since) {}

  static Pose2 truth(Time time) {
    const double t = to_seconds(time);
    return {{2.0 + kSpeed * t, 1.5 + 0.2 * std::sin(t)}, 0.2 * std::sin(0.7 * t)};
  }
  /// Scans as seen from a scanner that sits `mount` on the body.
  void send_scans(const Pose2& mount = {}) {
    every(topic::scan, 100ms, Time{}, [this, mount](Time now) {
      const LaserScan seen =
          plan_.scan(truth(now + since_) * mount, 360, 1.5 * M_PI, 0.01, random_);
      sensor_msgs::msg::LaserScan scan = to_msg(seen);
      scan.header(make_header(now, frame::kLaser));
      return scan;
    });
  }
  /// Of a body whose odometry is right at first and 10 % too long.
  void send_odometry_that_drifts(Time until = Time::max()) {
    every(
        topic::odometry, 10ms, Time{}, [](Time now) { return drifting_odometry(now); }, until);
  }
  static nav_msgs::msg::Odometry drifting_odometry(Time now) {
    Pose2 pose = truth(now);
    pose.position.x() += 0.1 * kSpeed * to_seconds(now);
    RigidBodyState state;
    state.p_WB = {pose.position.x(), pose.position.y(), 1.0};
    state.q_WB = from_yaw(pose.yaw);
    return to_odometry(now, state);
  }
  void tell(const StaticTransforms::Pose& mount) {
    const auto publisher =
        std::make_shared<Publisher<tf2_msgs::msg::TFMessage>>(probe.advertise(topic::tf_static));
    at(Time{}, publisher, [mount](Time now) {
      tf2_msgs::msg::TFMessage message;
      message.transforms({to_transform(now, frame::kBody, frame::kLaser, mount)});
      return message;
    });
  }

 private:
  Duration since_;
  FloorPlan plan_ = office_floor();
  std::mt19937 random_{1};
};

inline double error_of(const geometry_msgs::msg::Pose& pose, const Pose2& truth) {
  return std::hypot(pose.position().x() - truth.position.x(),
                    pose.position().y() - truth.position.y());
}

}  // namespace swiftlet::test
