// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/line_matcher.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

ScanPoints placed(const ScanPoints& points, const Pose2& pose) {
  ScanPoints result;
  const Eigen::Rotation2Dd R(pose.yaw);
  for (const SurfacePoint& p : points) result.push_back({pose * p.position, R * p.normal});
  return result;
}

/// What is seen from a place where there is more than a corridor.
const Pose2 kPlace{{1.7, 1.4}, 0.4};

ScanPoints seen_from(const FloorPlan& plan, const Pose2& pose, double noise, std::mt19937& random) {
  return scan_points(plan.scan(pose, 720, 2 * M_PI, noise, random));
}

TEST(LineMatcher, BringsAScanBackToWhereItWasTaken) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const FloorPlan plan = office_floor();
  const SurfaceIndex map(placed(seen_from(plan, kPlace, 0.0, random), kPlace));
  for (int trial = 0; trial < 50; ++trial) {
    Pose2 truth = kPlace;
    truth.position += 0.3 * Vector2d(uniform(random), uniform(random));
    truth.yaw += M_PI * uniform(random);
    Pose2 guess = truth;
    guess.position += 0.12 * Vector2d(uniform(random), uniform(random));
    guess.yaw += 0.04 * uniform(random);
    const LineMatch match = match_lines(map, seen_from(plan, truth, 0.0, random), guess);
    EXPECT_TRUE(match.converged);
    EXPECT_LT((match.pose.position - truth.position).norm(), 2e-3) << trial;
    EXPECT_NEAR(wrap_angle(match.pose.yaw - truth.yaw), 0.0, 1e-3) << trial;
    EXPECT_GT(match.inliers, 0.8);
    EXPECT_LT(match.rms, 0.01);
  }
}

TEST(LineMatcher, ErrorsAreAsLargeAsTheInformationSays) {
  std::mt19937 random(2);
  const FloorPlan plan = office_floor();
  const SurfaceIndex map(placed(seen_from(plan, kPlace, 0.0, random), kPlace));
  LineMatchNoise noise;
  noise.sigma = 0.01;
  noise.points_alike = 1.0;  // these are independent
  constexpr int kRuns = 200;
  double nees = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const LineMatch match = match_lines(map, seen_from(plan, kPlace, noise.sigma, random), kPlace);
    Vector3d error;
    error << match.pose.position - kPlace.position, wrap_angle(match.pose.yaw - kPlace.yaw);
    nees += error.dot(information_in(match, 0.0, noise) * error);
  }
  // 3 kRuns degrees of freedom. Noise is along the beam, and a beam that grazes a wall errs less
  // across it: the errors are somewhat smaller than they are said to be, never larger.
  EXPECT_LT(nees / (3.0 * kRuns), 1.05);
  EXPECT_GT(nees / (3.0 * kRuns), 0.4);
}

TEST(LineMatcher, ACorridorTellsNothingAlongItself) {
  std::mt19937 random(3);
  FloorPlan corridor;
  corridor.add_wall({-100, -1.2}, {100, -1.2});
  corridor.add_wall({-100, 1.2}, {100, 1.2});
  const Pose2 pose{{0, 0}, 0.5};
  const ScanPoints scan = seen_from(corridor, pose, 0.0, random);
  const LineMatch match = match_lines(SurfaceIndex(placed(scan, pose)), scan, pose);
  const Matrix3d covariance = information_in(match, 0.0, {}).inverse();
  EXPECT_GT(covariance(0, 0), 1e4 * covariance(1, 1));
  // The same, said in the frame of a vehicle that looks across the corridor.
  const Matrix3d turned = information_in(match, M_PI_2, {}).inverse();
  EXPECT_NEAR(turned(1, 1), covariance(0, 0), 1e-6 * covariance(0, 0));
  EXPECT_NEAR(turned(2, 2), covariance(2, 2), 1e-6 * covariance(2, 2));
}

TEST(LineMatcher, APriorSaysWhatTheScanDoesNot) {
  std::mt19937 random(4);
  FloorPlan corridor;
  corridor.add_wall({-100, -1.2}, {100, -1.2});
  corridor.add_wall({-100, 1.2}, {100, 1.2});
  const ScanPoints scan = seen_from(corridor, {}, 0.0, random);
  const SurfaceIndex map(scan);
  const LineMatchNoise noise;
  PosePrior prior;
  prior.pose = {{0.15, 0.05}, 0.02};
  prior.information = noise.variance() * Vector3d(1e4, 1e2, 1e2).asDiagonal().toDenseMatrix();
  const LineMatch match = match_lines(map, scan, prior.pose, {}, prior);
  EXPECT_NEAR(match.pose.position.x(), 0.15, 0.01);
  EXPECT_NEAR(match.pose.position.y(), 0.0, 2e-3);
  EXPECT_NEAR(match.pose.yaw, 0.0, 1e-3);
}

TEST(LineMatcher, TheOtherSideOfAThinWallIsNoPartner) {
  // Seen from above, then from below: 4 cm apart, as far as the guess is off.
  ScanPoints above, below;
  for (int i = 0; i < 100; ++i) {
    above.push_back({{0.05 * i, 0.04}, {0, 1}});
    below.push_back({{0.05 * i, 0.0}, {0, -1}});
  }
  const LineMatch match = match_lines(SurfaceIndex(above), below, Pose2{});
  EXPECT_EQ(match.inliers, 0.0);
}

TEST(LineMatcher, WhereThereIsNothingTheGuessStays) {
  std::mt19937 random(5);
  const ScanPoints scan = seen_from(office_floor(), kPlace, 0.0, random);
  const Pose2 guess{{100, 100}, 1.0};
  for (const auto& [map, points] :
       {std::pair(ScanPoints{}, scan), std::pair(scan, ScanPoints{}), std::pair(scan, scan)}) {
    const LineMatch match = match_lines(SurfaceIndex(map), points, guess);
    EXPECT_EQ(match.pose.position, guess.position);
    EXPECT_EQ(match.inliers, 0.0);
    EXPECT_TRUE(match.information.isZero());
  }
}

TEST(SurfaceIndex, TheNearestIsTheNearestOfAll) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  ScanPoints points;
  for (int i = 0; i < 400; ++i) {
    points.push_back(
        {{uniform(random), uniform(random)}, i % 5 == 0 ? Vector2d(0, 0) : Vector2d(1, 0)});
  }
  const SurfaceIndex index(points, 0.25);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector2d place = 1.1 * Vector2d(uniform(random), uniform(random));
    double least = 0.25;
    for (const SurfacePoint& p : points) {
      if (p.has_normal()) least = std::min(least, (p.position - place).norm());
    }
    const SurfacePoint* nearest = index.nearest(place, 0.25);
    ASSERT_EQ(nearest == nullptr, least == 0.25);
    if (nearest == nullptr) continue;
    EXPECT_NEAR((nearest->position - place).norm(), least, 1e-12);
  }
}

TEST(LineMatcher, ItKnowsWhichWayACorridorGoes) {
  std::mt19937 random(5);
  for (const double direction : {0.0, 0.7, 2.0}) {
    const Vector2d along(std::cos(direction), std::sin(direction)), across(-along.y(), along.x());
    FloorPlan corridor;
    for (const double side : {-1.2, 1.2}) {
      corridor.add_wall(side * across - 100.0 * along, side * across + 100.0 * along);
    }
    const ScanPoints seen = seen_from(corridor, Pose2{}, 0.0, random);
    const LeastKnown least = least_known(match_lines(SurfaceIndex(seen), seen, Pose2{}));
    EXPECT_NEAR(std::abs(least.direction.dot(along)), 1.0, 1e-3) << direction;
    EXPECT_LT(least.information, 1.0) << direction;
  }
  const ScanPoints seen = seen_from(office_floor(), kPlace, 0.0, random);
  EXPECT_GT(least_known(match_lines(SurfaceIndex(seen), seen, Pose2{})).information, 100.0);
}

}  // namespace
}  // namespace swiftlet::test
