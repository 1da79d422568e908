// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Maps that outlive the mapper that made them.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "components/lidar_mapper/map_file.hpp"
#include "components/lidar_mapper/map_message.hpp"
#include "tests/components/slam_bench.hpp"

namespace swiftlet::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class LidarMapFile : public testing::Test {
 protected:
  LidarMapFile()
      : folder_(fs::temp_directory_path() /
                ("swiftlet-map-" + std::to_string(getpid()) + "-" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~LidarMapFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  fs::path file(const std::string& name = "house.mcap") const { return folder_ / name; }

  /// Maps the first 20 s of the corridor.
  SlamMap map_the_corridor() const {
    {
      SlamBench bench(", save: " + file().string());
      bench.send_scans();
      bench.run_until(Time(20s));
    }
    auto map = load_map_file(file());
    EXPECT_TRUE(map.ok()) << map.error().reason;
    return std::move(map).value();
  }
  /// What keeps a mapper from beginning with these parameters.
  static std::string refusal(const std::string& parameters) {
    try {
      SlamBench bench(parameters);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_;
};

/// Where the corridor's poses are in the frame of a map, which is its first scan's.
Pose2 in(const SlamMap& map, Time time) {
  return SlamBench::truth(map.graph.keyframes.front()->time).inverse() * SlamBench::truth(time);
}

TEST_F(LidarMapFile, HoldsWhatTheMapperKnew) {
  const SlamMap map = map_the_corridor();
  ASSERT_GT(map.scans.size(), 25u);
  ASSERT_EQ(map.graph.keyframes.size(), map.scans.size());
  ASSERT_EQ(map.graph.poses.size(), map.scans.size());
  EXPECT_GE(map.graph.constraints.size(), map.scans.size() - 1);
  for (std::size_t i = 0; i < map.scans.size(); ++i) {
    const Pose2 truth = in(map, map.graph.keyframes[i]->time);
    EXPECT_LT((map.graph.poses[i].position - truth.position).norm(), 0.08);
    EXPECT_EQ(map.scans[i]->scan.ranges.size(), 360u);
  }

  // Saved again it is the same map.
  const fs::path again = file("again.mcap");
  ASSERT_TRUE(save_map_file(map, OccupancyGrid(), Time(20s), again).ok());
  const auto copy = load_map_file(again);
  ASSERT_TRUE(copy.ok()) << copy.error().reason;
  EXPECT_EQ(to_msg(*copy, Time{}), to_msg(map, Time{}));
}

TEST_F(LidarMapFile, AMapperFindsItselfInItAndLeavesItAsItIs) {
  const SlamMap before = map_the_corridor();
  // The other way would look different to its 270 degrees; the same way from farther on.
  SlamBench bench(
      ", load: " + file().string() + ", stay: true, save: " + file("after.mcap").string(), 8s);
  bench.send_scans();
  bench.run_until(Time(10s));
  ASSERT_GT(bench.poses.size(), 40u) << "it needed longer than six seconds";
  for (const auto& message : bench.poses) {
    const Time time = from_msg(message.header().stamp());
    EXPECT_LT(error_of(message.pose().pose(), in(before, time + 8s)), 0.10) << to_seconds(time);
  }
  // The map that was loaded is told from the beginning.
  ASSERT_FALSE(bench.maps.empty());
  EXPECT_LT(from_msg(bench.maps.front().header().stamp()), Time(1s));
}

TEST_F(LidarMapFile, WithAFirstPoseItKnowsAtOnceAndGoesOnMapping) {
  const SlamMap before = map_the_corridor();
  {
    SlamBench bench(", load: " + file().string() +
                        ", first_pose: [8.0, 0.5, 0.1], save: " + file("after.mcap").string(),
                    15s);
    bench.send_scans();
    bench.run_until(Time(15s));
    ASSERT_GT(bench.poses.size(), 140u);
    for (const auto& message : bench.poses) {
      const Time time = from_msg(message.header().stamp());
      EXPECT_LT(error_of(message.pose().pose(), in(before, time + 15s)), 0.12) << to_seconds(time);
    }
  }
  const auto after = load_map_file(file("after.mcap"));
  ASSERT_TRUE(after.ok()) << after.error().reason;
  EXPECT_GT(after->scans.size(), before.scans.size() + 10);
  for (std::size_t i = 0; i < before.scans.size(); ++i) {
    EXPECT_LT((after->graph.poses[i].position - before.graph.poses[i].position).norm(), 0.05);
  }
}

TEST_F(LidarMapFile, WhatCannotBeLoadedIsRefusedWithTheReason) {
  EXPECT_THAT(refusal(", load: " + file().string()),
              AllOf(HasSubstr("lidar_mapper.load"), HasSubstr(file().string())));
  std::ofstream(file("text.mcap")) << "not a map";
  EXPECT_THAT(refusal(", load: " + file("text.mcap").string()), HasSubstr("text.mcap"));
  EXPECT_THAT(refusal(", first_pose: [1, 2]"), HasSubstr("[x, y, yaw]"));

  map_the_corridor();
  std::ifstream in(file(), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = bytes.size() / 2; at < bytes.size() / 2 + 64; ++at) bytes[at] ^= 0x5a;
  std::ofstream(file("changed.mcap"), std::ios::binary) << bytes;
  EXPECT_THAT(refusal(", load: " + file("changed.mcap").string()), HasSubstr("changed.mcap"));
}

TEST_F(LidarMapFile, AMapThatContradictsItselfIsNone) {
  const SlamMap map = map_the_corridor();
  const auto good = to_msg(map, Time{});
  ASSERT_TRUE(from_msg(good).ok());
  auto edge = good;
  edge.constraints().front().to(static_cast<std::uint32_t>(map.scans.size()));
  EXPECT_THAT(from_msg(edge).error().reason, HasSubstr("constraint 0"));
  auto pose = good;
  pose.keyframes()[3].yaw(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(from_msg(pose).error().reason, HasSubstr("keyframe 3"));
  auto tilt = good;
  tilt.keyframes()[1].tilt().w(0.0);
  EXPECT_THAT(from_msg(tilt).error().reason, HasSubstr("keyframe 1"));
}

}  // namespace
}  // namespace swiftlet::test
