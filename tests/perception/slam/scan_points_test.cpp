// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/scan_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;

FloorPlan room() {
  FloorPlan plan;
  plan.add_box({-3, -2}, {4, 5});
  return plan;
}

TEST(ScanPoints, NormalsAreThoseOfTheWallsAndFaceTheScanner) {
  std::mt19937 random(1);
  const ScanPoints points = scan_points(room().scan({}, 720, 2 * M_PI, 0.0, random));
  int with_normal = 0;
  for (const SurfacePoint& p : points) {
    if (!p.has_normal()) continue;
    ++with_normal;
    EXPECT_LT(p.normal.dot(p.position), 0.0);
    EXPECT_NEAR(p.normal.norm(), 1.0, 1e-9);
    // A corner rounds the line through its neighbours.
    const Vector2d to_corner = (p.position - Vector2d(0.5, 1.5)).cwiseAbs() - Vector2d(3.5, 3.5);
    if (to_corner.maxCoeff() - to_corner.minCoeff() < 0.35) continue;
    EXPECT_NEAR(p.normal.cwiseAbs().maxCoeff(), 1.0, 1e-6) << p.position.transpose();
  }
  EXPECT_GT(with_normal, 0.9 * static_cast<double>(points.size()));
}

TEST(ScanPoints, PointsAreNoNearerToTheNextThanTheSpacing) {
  std::mt19937 random(1);
  ScanPointsParams params;
  params.spacing = 0.10;
  const ScanPoints points = scan_points(room().scan({}, 3600, 2 * M_PI, 0.0, random), {}, params);
  ASSERT_GT(points.size(), 200u);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GE((points[i].position - points[i - 1].position).norm(), 0.10);
  }
}

TEST(ScanPoints, ALonePostHasNoNormal) {
  std::mt19937 random(1);
  FloorPlan plan = room();
  plan.add_box({1.99, -0.01}, {2.01, 0.01});
  const ScanPoints points = scan_points(plan.scan({}, 720, 2 * M_PI, 0.0, random));
  int of_post = 0;
  for (const SurfacePoint& p : points) {
    if ((p.position - Vector2d(2, 0)).norm() > 0.1) continue;
    ++of_post;
    EXPECT_FALSE(p.has_normal());
  }
  EXPECT_GT(of_post, 0);
}

TEST(ScanPoints, WhatIsNoReturnGivesNoPoint) {
  LaserScan scan;
  scan.angle_increment = 0.01;
  scan.range_min = 0.1;
  scan.range_max = 10.0;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  scan.ranges = {nan, infinite, -infinite, 0.05f, 10.0f, 2.0f, -1.0f};
  const ScanPoints points = scan_points(scan);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].position.norm(), 2.0, 1e-6);
  EXPECT_FALSE(points[0].has_normal());
}

TEST(ScanPoints, NonsensicalTimesAndAnglesGiveNoPoints) {
  std::mt19937 random(1);
  ScannerMotion motion;
  motion.velocity = {1.0, 0.0};
  for (const double nonsense : {std::nan(""), std::numeric_limits<double>::infinity(), 1e12}) {
    LaserScan scan = room().scan({}, 90, 2 * M_PI, 0.0, random);
    scan.time_increment = nonsense;
    EXPECT_LE(scan_points(scan, motion).size(), 1u) << "the first beam has no time";
    scan.time_increment = 0.0;
    scan.angle_increment = nonsense;
    for (const SurfacePoint& p : scan_points(scan, motion)) EXPECT_TRUE(p.position.allFinite());
  }
}

/// Distances of points to the walls of room() [m].
double farthest_from_wall(const ScanPoints& points) {
  double farthest = 0.0;
  for (const SurfacePoint& p : points) {
    const double x = std::min(std::abs(p.position.x() + 3.0), std::abs(p.position.x() - 4.0));
    const double y = std::min(std::abs(p.position.y() + 2.0), std::abs(p.position.y() - 5.0));
    farthest = std::max(farthest, std::min(x, y));
  }
  return farthest;
}

TEST(ScanPoints, ATiltedScannerSeesTheSameRoom) {
  const FloorPlan plan = room();
  ScannerMotion motion;
  motion.q_HL = Eigen::AngleAxisd(0.25, Eigen::Vector3d(0.6, 0.8, 0.0));
  LaserScan scan;
  scan.angle_increment = 2 * M_PI / 720;
  scan.range_max = 30.0;
  for (int i = 0; i < 720; ++i) {
    const double angle = i * scan.angle_increment;
    const Eigen::Vector3d beam = motion.q_HL * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    const double level = plan.range({0, 0}, std::atan2(beam.y(), beam.x()));
    scan.ranges.push_back(static_cast<float>(level / beam.head<2>().norm()));
  }
  EXPECT_LT(farthest_from_wall(scan_points(scan, motion)), 1e-5);
  EXPECT_GT(farthest_from_wall(scan_points(scan)), 0.05);

  // Half a metre above the floor, what points down sees it before the wall.
  motion.height = 0.5;
  motion.min_height = 0.1;
  for (const SurfacePoint& p : scan_points(scan, motion)) {
    const Eigen::Vector3d up = motion.q_HL * Eigen::Vector3d::UnitZ();
    const double rise = -(up.x() * p.position.x() + up.y() * p.position.y()) / up.z();
    EXPECT_GE(motion.height + rise, 0.1 - 1e-6);
  }
  EXPECT_LT(scan_points(scan, motion).size(), scan_points(scan).size());
}

TEST(ScanPoints, WhatTheScannerMovedBetweenTheBeamsIsTakenOut) {
  const FloorPlan plan = room();
  ScannerMotion motion;
  motion.velocity = {1.5, -0.5};
  motion.yaw_rate = 2.0;
  LaserScan scan;
  scan.angle_increment = 2 * M_PI / 720;
  scan.time_increment = 0.1 / 720;
  scan.range_max = 30.0;
  for (int i = 0; i < 720; ++i) {
    const double later = i * scan.time_increment;
    const double angle = i * scan.angle_increment + motion.yaw_rate * later;
    scan.ranges.push_back(static_cast<float>(plan.range(motion.velocity * later, angle)));
  }
  EXPECT_LT(farthest_from_wall(scan_points(scan, motion)), 1e-5);
  EXPECT_GT(farthest_from_wall(scan_points(scan)), 0.1);
}

}  // namespace
}  // namespace swiftlet::test
