// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The mapper that finds its poses itself, in lockstep.
#include <gmock/gmock.h>

#include <cmath>

#include "components/lidar_mapper/grid_message.hpp"
#include "components/static_transforms.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/component_bench.hpp"
#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;

constexpr double kSpeed = 0.5;  // [m/s]

/// Flies along the lower corridor of office_floor(), without odometry unless it is asked for.
struct SlamBench : Bench {
  std::vector<geometry_msgs::msg::PoseWithCovarianceStamped>& poses = record(topic::lidar_pose);
  std::vector<nav_msgs::msg::Path>& paths = record(topic::lidar_path);
  std::vector<nav_msgs::msg::OccupancyGrid>& maps = record(topic::map);

  SlamBench() : Bench("lidar_mapper", "{slam: true, min_height: 0.0}") {}

  static Pose2 truth(Time time) {
    const double t = to_seconds(time);
    return {{2.0 + kSpeed * t, 1.5 + 0.2 * std::sin(t)}, 0.2 * std::sin(0.7 * t)};
  }
  /// Scans as seen from a scanner that sits `mount` on the body.
  void send_scans(const Pose2& mount = {}) {
    every(topic::scan, 100ms, Time{}, [this, mount](Time now) {
      const LaserScan seen = plan_.scan(truth(now) * mount, 360, 1.5 * M_PI, 0.01, random_);
      sensor_msgs::msg::LaserScan scan;
      scan.header(make_header(now, frame::kLaser));
      scan.angle_min(static_cast<float>(seen.angle_min));
      scan.angle_increment(static_cast<float>(seen.angle_increment));
      scan.range_min(static_cast<float>(seen.range_min));
      scan.range_max(static_cast<float>(seen.range_max));
      scan.ranges(seen.ranges);
      return scan;
    });
  }
  /// Of a body whose odometry is right at first and 10 % too long.
  void send_odometry_that_drifts() {
    every(topic::odometry, 10ms, Time{}, [](Time now) {
      Pose2 pose = truth(now);
      pose.position.x() += 0.1 * kSpeed * to_seconds(now);
      RigidBodyState state;
      state.p_WB = {pose.position.x(), pose.position.y(), 1.0};
      state.q_WB = from_yaw(pose.yaw);
      return to_odometry(now, state);
    });
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
  FloorPlan plan_ = office_floor();
  std::mt19937 random_{1};
};

double error_of(const geometry_msgs::msg::Pose& pose, const Pose2& truth) {
  return std::hypot(pose.position().x() - truth.position.x(),
                    pose.position().y() - truth.position.y());
}

TEST(LidarSlamMapper, WithoutOdometryItTellsItsPoseFromWhereItBegan) {
  SlamBench bench;
  bench.send_scans();
  bench.run_until(Time(20s));
  ASSERT_GT(bench.poses.size(), 190u);
  const Pose2 begin = SlamBench::truth(from_msg(bench.poses.front().header().stamp()));
  for (const auto& message : bench.poses) {
    const Pose2 truth = begin.inverse() * SlamBench::truth(from_msg(message.header().stamp()));
    EXPECT_LT(error_of(message.pose().pose(), truth), 0.10);
    EXPECT_EQ(message.header().frame_id(), frame::kMap);
  }
  // What it does not see it does not claim to know.
  const auto& covariance = bench.poses.back().pose().covariance();
  EXPECT_LT(covariance[0], 0.01);
  EXPECT_GT(covariance[14], 1e3);
  EXPECT_GT(covariance[21], 1e3);

  ASSERT_FALSE(bench.paths.empty());
  EXPECT_GT(bench.paths.back().poses().size(), 180u);
  ASSERT_FALSE(bench.maps.empty());
  const OccupancyGrid map = from_msg(bench.maps.back(), {});
  EXPECT_GT(map.width() * map.resolution(), 20.0);
}

TEST(LidarSlamMapper, OdometryHelpsAndItsDriftIsTakenOut) {
  SlamBench bench;
  bench.tell({{0.1, 0.05, 0.2}, from_yaw(0.5)});
  bench.send_odometry_that_drifts();
  bench.send_scans({{0.1, 0.05}, 0.5});
  bench.run_until(Time(20s));
  ASSERT_GT(bench.poses.size(), 150u);
  // The body's pose, in the frame in which odometry began: the scanner sits elsewhere.
  const auto& last = bench.poses.back();
  EXPECT_LT(error_of(last.pose().pose(), SlamBench::truth(from_msg(last.header().stamp()))), 0.15);
  EXPECT_NEAR(last.pose().pose().position().z(), 1.0, 1e-6);
}

TEST(LidarSlamMapper, TheSameScansGiveTheSameBytes) {
  std::vector<std::vector<double>> runs;
  for (int run = 0; run < 2; ++run) {
    SlamBench bench;
    bench.send_scans();
    bench.run_until(Time(8s));
    auto& values = runs.emplace_back();
    for (const auto& message : bench.poses) {
      values.push_back(message.pose().pose().position().x());
      values.push_back(message.pose().pose().orientation().z());
    }
  }
  EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace swiftlet::test
