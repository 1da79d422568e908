// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/lidar_slam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/perception/slam/drive.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;

TEST(LidarSlam, WithoutOdometryItGoesAroundTheBlockAndKnowsWhereItBegan) {
  Drive drive(1);
  drive.along(way_around(1.3));
  EXPECT_EQ(drive.lost, 0);
  EXPECT_GT(drive.closures, 3u);
  EXPECT_LT(largest(drive.errors(drive.live)), 0.5);
  EXPECT_LT(mean(drive.errors(drive.now())), 0.03);
  EXPECT_LT(largest(drive.errors(drive.now())), 0.08);
}

TEST(LidarSlam, ABackEndThatIsLateGivesTheSameMap) {
  Drive drive(2);
  drive.late = 40;  // nine seconds
  drive.along(way_around(1.5));
  EXPECT_GT(drive.closures, 3u);
  EXPECT_LT(mean(drive.errors(drive.now())), 0.06);
}

TEST(LidarSlam, TheSameScansGiveTheSamePosesBitForBit) {
  std::vector<std::vector<Pose2>> poses;
  for (int run = 0; run < 2; ++run) {
    Drive drive(3);
    drive.along(way_around(1.1));
    poses.push_back(drive.now());
  }
  ASSERT_EQ(poses[0].size(), poses[1].size());
  for (std::size_t i = 0; i < poses[0].size(); ++i) {
    EXPECT_EQ(poses[0][i].vector(), poses[1][i].vector()) << i;
  }
}

TEST(LidarSlam, AfterAGapItFindsItselfInItsOwnMap) {
  Drive drive(4);
  drive.field_of_view = M_PI;
  drive.along(way_around(1.0));
  const double seconds = static_cast<double>(drive.truth.size()) / kRate_hz;
  // Eight seconds later, 2.5 m on, looking back.
  const Pose2 elsewhere{{4.0, 1.4}, 2.6};
  const auto update = drive.see(elsewhere, seconds + 8.0);
  EXPECT_FALSE(update.lost);
  const Pose2 expected = drive.truth.front().inverse() * elsewhere;
  EXPECT_LT((update.pose.position - expected.position).norm(), 0.5);
  EXPECT_NEAR(wrap_angle(update.pose.yaw - expected.yaw), 0.0, 0.05);
}

TEST(LidarSlam, OdometryIsFollowedWhereThereIsNothingToSee) {
  LidarSlam slam;
  Pose2 odometry;
  EXPECT_FALSE(slam.add(at(0), {}, odometry).lost);
  odometry = {{1.0, 0.0}, 0.1};
  const auto update = slam.add(at(1), {}, odometry);
  EXPECT_TRUE(update.lost);
  EXPECT_EQ(update.pose.vector(), odometry.vector());
  EXPECT_GT(update.covariance(0, 0), 1e-4);
  // And without it, there is no better guess than the last pose.
  const auto blind = slam.add(at(2), {});
  EXPECT_TRUE(blind.lost);
  EXPECT_EQ(blind.pose.vector(), odometry.vector());
  EXPECT_GT(blind.covariance(0, 0), update.covariance(0, 0));
}

TEST(LidarSlam, OdometryThatDriftsIsPutRight) {
  Drive drive(5);
  std::mt19937 random(6);
  std::normal_distribution<double> normal(0.0, 1.0);
  Pose2 odometry;
  const std::vector<Pose2> way = way_around(1.2);
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0) {
      Pose2 moved = way[i - 1].inverse() * way[i];
      moved.position *= 1.03;
      moved.yaw += 0.004 + 0.003 * normal(random);
      odometry = odometry * moved;
    }
    drive.see(way[i], static_cast<double>(i) / kRate_hz, odometry);
  }
  const Pose2 end = way.front().inverse() * way.back();
  ASSERT_GT((odometry.position - end.position).norm(), 2.0);
  EXPECT_LT(mean(drive.errors(drive.now())), 0.05);
}

TEST(LidarSlam, OdometryThatJumpsOrIsNoNumberIsPassedOver) {
  for (const double jump : {50.0, 1e12, std::nan("")}) {
    Drive drive(8);
    const std::vector<Pose2> way = way_around(0.2);
    for (std::size_t i = 0; i < way.size(); ++i) {
      Pose2 odometry = way.front().inverse() * way[i];
      if (i == 12) odometry.position.x() += jump;
      if (i > 12 && std::isfinite(jump)) odometry.position.x() += jump;
      drive.see(way[i], static_cast<double>(i) / kRate_hz, odometry);
    }
    EXPECT_EQ(drive.lost, 0) << jump;
    EXPECT_LT(largest(drive.errors(drive.now())), 0.1) << jump;
  }
}

/// Four blocks that are alike, with bare corridors around them and between.
FloorPlan alike_blocks() {
  FloorPlan plan;
  plan.add_box({0, 0}, {30, 20});
  for (const double x : {2.2, 16.0}) {
    for (const double y : {2.2, 11.2}) plan.add_box({x, y}, {x + 11.6, y + 6.6});
  }
  return plan;
}

TEST(LidarSlam, InBareCorridorsItGoesOnAsFastAsItCame) {
  Drive drive(9, alike_blocks());
  drive.field_of_view = M_PI;
  const Vector2d south_west(1.2, 1.2), south(14.9, 1.2), middle(14.9, 10.0), west(1.2, 10.0),
      east(28.9, 10.0), north_east(28.9, 18.9), north(14.9, 18.9);
  drive.along(way_along(
      {south_west, south, middle, east, north_east, north, middle, west, south_west, south}, 0.0));
  EXPECT_EQ(drive.lost, 0);
  EXPECT_LT(largest(drive.errors(drive.live)), 0.4);
  EXPECT_LT(mean(drive.errors(drive.now())), 0.04);
}

TEST(LidarSlam, WhoStopsWhereThereIsSomethingToSeeIsNotThoughtToGoOn) {
  Drive drive(10);
  drive.along(way_along({{1.5, 1.5}, {12.0, 1.6}}, 0.0));
  const Pose2 stop = drive.truth.back();
  for (int i = 0; i < 20; ++i) drive.see(stop, static_cast<double>(drive.truth.size()) / kRate_hz);
  EXPECT_LT(drive.errors(drive.live).back(), 0.05);
}

/// A corridor of 16 m with a recess in its northern wall every 2.5 m.
FloorPlan corridor_with_recesses() {
  constexpr double kLength = 16.0, kWidth = 2.4, kEvery = 2.5, kSize = 0.4;
  FloorPlan plan;
  plan.add_wall({0, 0}, {kLength, 0});
  plan.add_wall({0, 0}, {0, kWidth});
  plan.add_wall({kLength, 0}, {kLength, kWidth});
  double x = 0.0;
  for (double recess = kEvery; recess + kSize < kLength; recess += kEvery) {
    plan.add_wall({x, kWidth}, {recess, kWidth});
    x = recess + kSize;
    plan.add_wall({recess, kWidth}, {recess, kWidth + kSize});
    plan.add_wall({recess, kWidth + kSize}, {x, kWidth + kSize});
    plan.add_wall({x, kWidth + kSize}, {x, kWidth});
  }
  plan.add_wall({x, kWidth}, {kLength, kWidth});
  return plan;
}

TEST(LidarSlam, StampsThatAreLateDoNotMakeItGoWhereTheScanDoesNotFit) {
  for (unsigned seed = 11; seed < 17; ++seed) {
    Drive drive(seed, corridor_with_recesses());
    drive.field_of_view = M_PI;
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    constexpr double kFast = 0.8;  // [m/s]
    for (double x = 1.5; x < 14.0; x += kFast / kRate_hz) {
      const double late = uniform(random) < 0.3 ? 0.5 * uniform(random) : 0.0;
      drive.see({{x, 1.2}, 0.0}, static_cast<double>(drive.truth.size()) / kRate_hz + late);
    }
    EXPECT_LT(largest(drive.errors(drive.live)), 0.2) << seed;
  }
}

TEST(LidarSlam, ACorridorIsUncertainAlongItsAxis) {
  FloorPlan corridor;
  corridor.add_wall({-200, -1.2}, {200, -1.2});
  corridor.add_wall({-200, 1.2}, {200, 1.2});
  std::mt19937 random(7);
  LidarSlam slam;
  LidarSlam::Update update;
  for (int i = 0; i < 10; ++i) {
    const LaserScan scan = corridor.scan({{0.1 * i, 0.0}, 0.0}, 360, M_PI, 0.01, random);
    update = slam.add(at(0.2 * i), scan_points(scan));
  }
  EXPECT_GT(update.covariance(0, 0), 100.0 * update.covariance(1, 1));
  EXPECT_LT(update.covariance(1, 1), 1e-3);
}

}  // namespace
}  // namespace swiftlet::test
