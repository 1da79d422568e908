// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The mapper that finds its poses itself, in lockstep.
#include <gmock/gmock.h>

#include <algorithm>

#include "components/lidar_mapper/grid_message.hpp"
#include "tests/components/slam_bench.hpp"

namespace swiftlet::test {
namespace {

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

TEST(LidarSlamMapper, GoesOnAtOnceWhereOdometryEnds) {
  SlamBench bench;
  bench.tell({{0.1, 0.05, 0.2}, from_yaw(0.5)});
  bench.send_odometry_that_drifts(Time(6s));
  bench.send_scans({{0.1, 0.05}, 0.5});
  std::vector<double> late;  // [s]
  bench.probe.subscribe(
      topic::lidar_pose, [&](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
        late.push_back(to_seconds(bench.probe.now() - from_msg(pose.header().stamp())));
      });
  bench.run_until(Time(20s));
  ASSERT_GT(late.size(), 190u) << "one a scan, but for the last";
  EXPECT_LT(*std::max_element(late.begin(), late.end()), 0.65) << "it waits once, for the gap";
  EXPECT_LT(*std::max_element(late.begin() + 80, late.end()), 0.05);
  const auto& last = bench.poses.back();
  EXPECT_LT(error_of(last.pose().pose(), SlamBench::truth(from_msg(last.header().stamp()))), 0.15);
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
