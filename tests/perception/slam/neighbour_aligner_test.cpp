// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/neighbour_aligner.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

/// Keyframes in a room, at known poses.
struct Keyframes {
  std::vector<Pose2> truth{{{2.0, 2.0}, 0.0},  {{2.5, 2.1}, 0.3},  {{3.1, 2.2}, 0.1},
                           {{3.4, 2.9}, -0.5}, {{2.6, 2.8}, -0.2}, {{2.2, 2.3}, 0.2}};
  std::vector<KeyframePtr> keyframes;

  Keyframes() {
    FloorPlan plan;
    plan.add_box({0.0, 0.0}, {6.0, 5.0});
    plan.add_box({4.2, 1.0}, {4.9, 1.6});
    plan.add_wall({0.0, 3.9}, {1.3, 3.2});
    std::mt19937 random(5);
    for (const Pose2& pose : truth) {
      const LaserScan scan = plan.scan(pose, 360, 2.0 * M_PI, 0.01, random);
      keyframes.push_back(std::make_shared<const Keyframe>(
          make_keyframe({}, scan_points(scan, ScannerMotion{}), std::nullopt)));
    }
  }
};

TEST(NeighbourAligner, SaysHowNeighboursLieThoughThePosesAreOff) {
  const Keyframes room;
  std::vector<Pose2> poses = room.truth;
  std::mt19937 random(6);
  std::normal_distribution<double> off(0.0, 0.03);
  for (Pose2& pose : poses) {
    pose = {pose.position + Eigen::Vector2d(off(random), off(random)), pose.yaw + off(random)};
  }
  const auto pairs = align_with_neighbours(room.keyframes, poses, 5, {}, {});
  ASSERT_EQ(pairs.size(), 5u);
  for (const PoseConstraint& pair : pairs) {
    EXPECT_EQ(pair.from, 5);
    EXPECT_LT(pair.to, 5);
    EXPECT_TRUE(pair.robust);
    const auto i = static_cast<std::size_t>(pair.to);
    const Pose2 error = (room.truth[5].inverse() * room.truth[i]).inverse() * pair.relative;
    EXPECT_LT(error.position.norm(), 0.01);
    EXPECT_LT(std::abs(error.yaw), 0.005);
  }
}

TEST(NeighbourAligner, TakesTheNearestAndNotWhatIsFarOrWasMistaken) {
  const Keyframes room;
  NeighbourParams params;
  params.most = 3;
  const auto nearest = align_with_neighbours(room.keyframes, room.truth, 5, params, {});
  ASSERT_EQ(nearest.size(), 3u);
  for (const PoseConstraint& pair : nearest) EXPECT_NE(pair.to, 2);  // of all the farthest

  params.most = 10;
  params.radius = 0.1;  // only the last two are neighbours wherever they are
  EXPECT_EQ(align_with_neighbours(room.keyframes, room.truth, 5, params, {}).size(), 2u);

  std::vector<Pose2> poses = room.truth;
  poses[5].yaw += 1.0;
  EXPECT_TRUE(align_with_neighbours(room.keyframes, poses, 5, {}, {}).empty());
  EXPECT_TRUE(align_with_neighbours(room.keyframes, room.truth, 0, {}, {}).empty());
}

}  // namespace
}  // namespace swiftlet::test
