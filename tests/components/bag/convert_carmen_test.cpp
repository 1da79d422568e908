// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/convert_carmen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "components/bag/mcap/verify.hpp"
#include "components/runtime/message.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/data_folder.hpp"

namespace swiftlet {
namespace {

struct Recording {
  std::vector<std::string> order;  // topics
  std::vector<sensor_msgs::msg::LaserScan> scans;
  std::vector<nav_msgs::msg::Odometry> poses;
};

template <class Header>
std::int64_t nanoseconds(const Header& header) {
  return header.stamp().sec() * 1'000'000'000LL + header.stamp().nanosec();
}

Recording read(const std::filesystem::path& path) {
  Recording recording;
  const auto reader = mcap::Reader::open(path);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader->header().profile, "ros2");
  mcap::MessageCursor cursor = reader->messages();
  for (auto next = cursor.next(); next.ok() && next->has_value(); next = cursor.next()) {
    const mcap::MessageView& view = **next;
    recording.order.push_back(view.channel->topic);
    EXPECT_EQ(view.channel->message_encoding, "cdr");
    EXPECT_EQ(view.schema->encoding, "ros2idl");
    std::int64_t stamp = 0;
    if (view.channel->topic == "scan") {
      EXPECT_EQ(view.schema->name, "sensor_msgs/msg/LaserScan");
      recording.scans.push_back(*from_cdr<sensor_msgs::msg::LaserScan>(view.message.data.copy()));
      stamp = nanoseconds(recording.scans.back().header());
    } else {
      EXPECT_EQ(view.schema->name, "nav_msgs/msg/Odometry");
      recording.poses.push_back(*from_cdr<nav_msgs::msg::Odometry>(view.message.data.copy()));
      stamp = nanoseconds(recording.poses.back().header());
    }
    EXPECT_EQ(static_cast<std::int64_t>(view.message.log_time), stamp);
  }
  return recording;
}

Recording convert(const std::string& text, const TemporaryFolder& folder) {
  std::istringstream stream(text);
  const auto log = carmen::parse_log(stream, "t.log");
  EXPECT_TRUE(log.ok());
  const auto done = convert_carmen(*log, folder / "t.mcap");
  EXPECT_TRUE(done.ok());
  return read(folder / "t.mcap");
}

TEST(ConvertCarmen, RawLogsKeepTheOdometryBetweenScansInTheFrameOfTheLaser) {
  const TemporaryFolder folder;
  // The laser is 0.1 m in front of the robot; the ODOM line of 2 s is that of the scan.
  const Recording made = convert(
      "ODOM 0 0 1.5707963267948966 0.4 0.3 0 1 h 1\nODOM 0 9 0 0 0 0 2 h 2\n"
      "FLASER 2 1 90 0.1 1 0 0 1 0 2 h 2\nODOM 5 1 0 0 0 0 3 h 3\n",
      folder);
  EXPECT_EQ(made.order, (std::vector<std::string>{"odometry", "odometry", "scan", "odometry"}));
  ASSERT_EQ(made.poses.size(), 3U);
  EXPECT_EQ(made.poses[0].header().frame_id(), "odom");
  EXPECT_EQ(made.poses[0].child_frame_id(), "laser");
  EXPECT_NEAR(made.poses[0].pose().pose().position().x(), 0.0, 1e-12);
  EXPECT_NEAR(made.poses[0].pose().pose().position().y(), 0.1, 1e-12);
  EXPECT_NEAR(made.poses[0].pose().pose().orientation().z(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(made.poses[0].pose().pose().position().z(), kUsualLaserHeight);
  EXPECT_NEAR(made.poses[0].pose().pose().orientation().w(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(made.poses[0].twist().twist().linear().x(), 0.4);
  EXPECT_EQ(made.poses[0].twist().twist().angular().z(), 0.3);
  EXPECT_NEAR(made.poses[1].pose().pose().position().y(), 1.0, 1e-12);
  EXPECT_NEAR(made.poses[2].pose().pose().position().x(), 5.1, 1e-12);
}

TEST(ConvertCarmen, AScanSaysWhereItsBeamsPointAndWhatNoReturnIs) {
  const TemporaryFolder folder;
  const Recording made = convert("FLASER 4 1 81.83 2 3 0 0 0 0 0 0 7.5 h 2\n", folder);
  ASSERT_EQ(made.scans.size(), 1U);
  const auto& scan = made.scans[0];
  EXPECT_EQ(scan.header().frame_id(), "laser");
  EXPECT_EQ(nanoseconds(scan.header()), 7'500'000'000);
  EXPECT_NEAR(scan.angle_min(), -1.5707963, 1e-6);
  EXPECT_NEAR(scan.angle_max(), 0.7853982, 1e-6);
  EXPECT_NEAR(scan.angle_min() + 3 * scan.angle_increment(), scan.angle_max(), 1e-6);
  EXPECT_EQ(scan.range_max(), 50.0F);
  EXPECT_GT(scan.range_min(), 0.0F);
  EXPECT_TRUE(std::isinf(scan.ranges()[1]));
  EXPECT_EQ(scan.ranges()[3], 3.0F);
}

TEST(ConvertCarmen, CorrectedLogsHaveThePosesOfTheScansAlone) {
  const TemporaryFolder folder;
  const Recording made =
      convert("NEFF 15\nODOM 3 3 0 0 0 0 1 h 1\nFLASER 1 1 4 5 0.5 4 5 0.5 2 h 2\n", folder);
  EXPECT_EQ(made.order, (std::vector<std::string>{"odometry", "scan"}));
  EXPECT_EQ(made.poses[0].header().frame_id(), "map");
  EXPECT_EQ(made.poses[0].pose().pose().position().x(), 4.0);
}

TEST(ConvertCarmen, RealLogsKeepEveryScanWithItsPose) {
  const auto data = data_folder() / "lidar2d";
  SWIFTLET_SKIP_WITHOUT(data);
  const TemporaryFolder folder;
  for (const char* name : {"intel_raw", "intel_corrected", "aces_corrected"}) {
    const auto log = carmen::read_log(data / (std::string(name) + ".log.gz"));
    ASSERT_TRUE(log.ok()) << log.error().reason;
    ASSERT_TRUE(convert_carmen(*log, folder / "f.mcap").ok());
    const auto found = mcap::verify(*mcap::open_file(folder / "f.mcap"));
    ASSERT_TRUE(found.ok());
    EXPECT_TRUE(found->problems.empty()) << found->problems.front();
    const Recording made = read(folder / "f.mcap");
    ASSERT_EQ(made.scans.size(), log->scans.size());
    std::map<std::int64_t, const nav_msgs::msg::Odometry*> pose_at;
    for (const auto& pose : made.poses) pose_at[nanoseconds(pose.header())] = &pose;
    for (std::size_t i = 0; i < made.scans.size(); ++i) {
      EXPECT_EQ(made.scans[i].ranges(), log->scans[i].ranges);
      const auto pose = pose_at.find(nanoseconds(made.scans[i].header()));
      ASSERT_NE(pose, pose_at.end());
      const auto& q = pose->second->pose().pose().orientation();
      EXPECT_NEAR(q.w() * q.w() + q.z() * q.z(), 1.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace swiftlet
