// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The logs of the SLAM benchmark, and its metric.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "components/experiments/data_table.hpp"
#include "components/experiments/slam/laser_logs.hpp"
#include "components/experiments/slam/odometry_times.hpp"
#include "components/experiments/slam/relations.hpp"
#include "tests/components/sim/fixture.hpp"
#include "tests/data_folder.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<TimedPose2> circle() {
  std::vector<TimedPose2> poses;
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.1 * i;
    poses.push_back({t, {{2.0 * std::cos(t), 2.0 * std::sin(t)}, wrap_angle(t + M_PI_2)}});
  }
  return poses;
}

PoseRelation relation(const std::vector<TimedPose2>& poses, std::size_t a, std::size_t b) {
  return {poses[a].t, poses[b].t, poses[a].pose.inverse() * poses[b].pose};
}

TEST(RelationErrors, WhereverATrajectoryIsPutItsShapeCounts) {
  const auto truth = circle();
  const std::vector<PoseRelation> relations{relation(truth, 0, 30), relation(truth, 25, 5)};
  auto moved = truth;
  const Pose2 elsewhere{{10.0, -3.0}, 2.0};
  for (TimedPose2& pose : moved) pose.pose = elsewhere * pose.pose;
  const RelationErrors errors = relation_errors(moved, relations);
  EXPECT_EQ(errors.count, 2u);
  EXPECT_LT(errors.translation_mean, 1e-12);
  EXPECT_LT(errors.rotation_mean, 1e-12);
}

TEST(RelationErrors, AreMeanAndDeviationOfLengthAndTurn) {
  const auto truth = circle();
  std::vector<PoseRelation> relations{relation(truth, 0, 10), relation(truth, 10, 20)};
  relations[0].relative.position.x() += 0.3;
  relations[1].relative.position.y() -= 0.1;
  relations[1].relative.yaw += 0.2;
  // One of which a pose was taken after the trajectory ended.
  relations.push_back({3.0, 4.5, Pose2{}});
  const RelationErrors errors = relation_errors(truth, relations);
  EXPECT_EQ(errors.count, 2u);
  EXPECT_NEAR(errors.translation_mean, 0.2, 1e-12);
  EXPECT_NEAR(errors.translation_std, 0.1, 1e-12);
  EXPECT_NEAR(errors.rotation_mean, 0.1, 1e-12);
  EXPECT_NEAR(errors.rotation_std, 0.1, 1e-12);
}

TEST(RelationErrors, OfAKnownTrajectoryAreThoseThatArePublishedForIt) {
  const auto folder = data_folder() / "lidar2d";
  SWIFTLET_SKIP_WITHOUT(folder);
  const auto table = read_table(folder / "intel910_gmapping_dense.txt");
  ASSERT_TRUE(table.ok()) << table.error().reason;
  std::vector<TimedPose2> trajectory;
  for (const auto& row : *table) trajectory.push_back({row[0], {{row[1], row[2]}, row[3]}});
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const TimedPose2& a, const TimedPose2& b) { return a.t < b.t; });
  const auto relations = read_relations(folder / "intel.relations");
  ASSERT_TRUE(relations.ok()) << relations.error().reason;
  const RelationErrors errors = relation_errors(trajectory, *relations);
  EXPECT_NEAR(errors.translation_mean, 0.066, 0.001);
  EXPECT_NEAR(errors.translation_std, 0.065, 0.001);
  EXPECT_NEAR(errors.rotation_mean * 180.0 / M_PI, 2.44, 0.02);
}

class LaserLogs : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    return folder_.write(name, content);
  }
  const test::TemporaryFolder folder_;
};

TEST_F(LaserLogs, AreFoundWithTheRelationsWhoseNameTheyBeginWith) {
  for (const char* name :
       {"intel2672_scans.txt.gz", "lab_raw.log.gz", "intel_raw.log.gz", "intel.relations",
        "intel26.relations", "other_scans_odom.txt.gz", "lab_corrected.log.gz"}) {
    write(name, "");
  }
  const auto logs = find_laser_logs(folder_.path());
  ASSERT_EQ(logs.size(), 3u);
  EXPECT_EQ(logs[0].name, "intel");
  EXPECT_EQ(logs[0].relations.filename(), "intel.relations");
  EXPECT_EQ(logs[1].name, "intel2672");
  EXPECT_EQ(logs[1].relations.filename(), "intel26.relations");
  EXPECT_EQ(logs[2].name, "lab");
  EXPECT_TRUE(logs[2].relations.empty());
}

TEST_F(LaserLogs, BeamsAreSpreadOverAHalfTurnAndOdometryIsWhereTheTitleSaysSo) {
  std::string ranges;
  for (int i = 0; i < 360; ++i) ranges += i == 7 ? " 81.83" : " 2.5";
  const auto plain = read_laser_log(write("a_scans.txt.gz", "# t r0..r359\n12.5" + ranges + "\n"));
  ASSERT_TRUE(plain.ok()) << plain.error().reason;
  ASSERT_EQ(plain->scans.size(), 1u);
  const carmen::Scan& scan = plain->scans.front();
  EXPECT_EQ(scan.time, Time(std::chrono::milliseconds(12500)));
  EXPECT_DOUBLE_EQ(scan.angle_min, -M_PI_2);
  EXPECT_DOUBLE_EQ(scan.angle_increment, M_PI / 360);
  EXPECT_TRUE(std::isinf(scan.ranges[7]));
  EXPECT_FLOAT_EQ(scan.ranges[8], 2.5f);
  EXPECT_FALSE(scan.has_pose);

  const auto with_odometry = read_laser_log(
      write("b_scans.txt.gz", "# t odom_x odom_y odom_theta r0..r359\n1 0.1 0.2 0.3" + ranges));
  ASSERT_TRUE(with_odometry.ok()) << with_odometry.error().reason;
  EXPECT_EQ(with_odometry->scans.front().ranges.size(), 360u);
  EXPECT_TRUE(with_odometry->scans.front().has_pose);
  EXPECT_DOUBLE_EQ(with_odometry->scans.front().laser_pose.theta, 0.3);
}

TEST_F(LaserLogs, WhatIsNoLogIsNamed) {
  const auto few = read_laser_log(write("c_scans.txt.gz", "1 2 3\n"));
  ASSERT_FALSE(few.ok());
  EXPECT_THAT(few.error().reason, AllOf(HasSubstr("c_scans.txt.gz"), HasSubstr("3 columns")));
  const auto relations = read_relations(write("d.relations", "1 2 3\n"));
  ASSERT_FALSE(relations.ok());
  EXPECT_THAT(relations.error().reason, HasSubstr("from to dx dy"));
}

/// A robot that drives straight on at 1 m/s, with odometry at 5 Hz.
carmen::Log steady_log() {
  carmen::Log log;
  for (int i = 0; i < 60; ++i) {
    carmen::Odometry odometry;
    odometry.time = Time(std::chrono::milliseconds(200 * i));
    odometry.pose = {0.2 * i, 0.0, 0.0};
    odometry.line = static_cast<std::size_t>(i);
    log.odometry.push_back(odometry);
  }
  return log;
}

TEST(TimedOdometry, StampsThatOnlyTellTheOrderGetTheTimeOfTheSteadyRate) {
  carmen::Log log = steady_log();
  // One that came 0.7 s late, and those that the logger therefore pushed on.
  log.odometry[30].time += std::chrono::milliseconds(700);
  for (int i = 1; i <= 3; ++i) {
    log.odometry[static_cast<std::size_t>(30 + i)].time =
        log.odometry[30].time + std::chrono::milliseconds(i);
  }
  const auto odometry = timed_odometry(log);
  ASSERT_EQ(odometry.size(), 60u);
  for (const TimedPose2& timed : odometry) {
    if (std::abs(timed.pose.position.x() - 6.0) < 1e-9) continue;  // the late one: nothing tells
    EXPECT_NEAR(timed.t, timed.pose.position.x(), 0.06);
  }
  EXPECT_TRUE(std::is_sorted(odometry.begin(), odometry.end(),
                             [](const TimedPose2& a, const TimedPose2& b) { return a.t < b.t; }));
}

TEST(TimedOdometry, AStampFromWhichNobodyCouldHaveComeToTheNextIsTakenBack) {
  carmen::Log log = steady_log();
  for (int i = 26; i < 30; ++i) log.odometry.erase(log.odometry.begin() + 26);  // lost
  carmen::Scan scan;
  scan.time = Time(std::chrono::milliseconds(6000));
  scan.robot_pose = {6.0, 0.0, 0.0};
  scan.has_pose = true;
  log.scans.push_back(scan);
  log.odometry[25].time = scan.time - std::chrono::milliseconds(1);  // 1 m before the scan
  log.odometry.erase(log.odometry.begin() + 26);                     // the one at the scan
  for (const TimedPose2& timed : timed_odometry(log)) {
    const double x = timed.pose.position.x();
    if (std::abs(x - 5.0) > 1e-9) {
      EXPECT_NEAR(timed.t, x, 1e-9);
    } else {
      EXPECT_NEAR(timed.t, 6.0 - 1.0 / 60.0, 1e-9);  // 60 m/s are believed
    }
  }
}

TEST(TimedOdometry, SoundStampsStayAsTheyAre) {
  const auto odometry = timed_odometry(steady_log());
  ASSERT_EQ(odometry.size(), 60u);
  for (const TimedPose2& timed : odometry) {
    EXPECT_NEAR(timed.t, timed.pose.position.x(), 1e-9);
  }
}

}  // namespace
}  // namespace swiftlet
