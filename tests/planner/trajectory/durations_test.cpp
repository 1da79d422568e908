// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/durations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/planner/trajectory/random_waypoints.hpp"

namespace swiftlet {
namespace {

using test::at_rest;
using test::moving;
using test::random_waypoints;

constexpr double kYawWeight = 0.1;  // as LeastSnapParams has it

double cost(const FlatReference& start, const std::vector<Waypoint>& waypoints,
            const std::vector<double>& durations) {
  return snap_cost(*minimum_snap(Time{}, start, waypoints, durations), kYawWeight);
}

double sum(const std::vector<double>& durations) {
  return std::accumulate(durations.begin(), durations.end(), 0.0);
}

/// Waypoints of which some prescribe how they are passed.
std::vector<Waypoint> some_prescribed(std::mt19937& random, int n) {
  auto waypoints = random_waypoints(random, n, 3.0);
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (i % 3 == 1) waypoints[i].velocity = Eigen::Vector3d(0.5, -0.3, 0.1);
    if (i % 4 == 2) waypoints[i].acceleration = Eigen::Vector3d(0.2, 0.4, -0.1);
  }
  return waypoints;
}

TEST(SnapCost, IsTheIntegralOfTheSquaredSnap) {
  std::mt19937 random(1);
  const auto waypoints = random_waypoints(random, 3, 2.0);
  const auto trajectory = *minimum_snap(Time{}, at_rest({0, 0, 1}), waypoints, {1.5, 2.0, 1.0});
  double position = 0.0, yaw = 0.0;
  constexpr int kSteps = 20000;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    for (int i = 0; i < kSteps; ++i) {
      const double s = (i + 0.5) / kSteps, dt = segment.duration_s / kSteps;
      for (int axis = kX; axis <= kZ; ++axis) {
        position += std::pow(derivative(segment, axis, s, 4), 2) * dt;
      }
      yaw += std::pow(derivative(segment, kYaw, s, 4), 2) * dt;
    }
  }
  EXPECT_NEAR(snap_cost(trajectory), position, 1e-6 * position);
  EXPECT_NEAR(snap_cost(trajectory, 0.3), position + 0.3 * yaw, 1e-6 * position);
}

TEST(SnapCostSlopes, AreFiniteDifferences) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> duration(0.8, 2.5);
  for (int trial = 0; trial < 40; ++trial) {
    const int n = 1 + trial % 6;
    const FlatReference start = trial % 2 == 0 ? at_rest({0, 0, 1}) : moving(random, 1.0, 1.0);
    const auto waypoints = some_prescribed(random, n);
    std::vector<double> T(static_cast<std::size_t>(n));
    for (double& t : T) t = duration(random);
    const auto slopes = snap_cost_slopes(*minimum_snap(Time{}, start, waypoints, T), kYawWeight);
    const double scale = cost(start, waypoints, T);
    for (std::size_t i = 0; i < T.size(); ++i) {
      constexpr double h = 1e-5;
      auto shorter = T, longer = T;
      shorter[i] -= h;
      longer[i] += h;
      const double difference =
          (cost(start, waypoints, longer) - cost(start, waypoints, shorter)) / (2 * h);
      ASSERT_NEAR(slopes[i], difference, 1e-6 * scale) << trial << " piece " << i;
    }
  }
}

TEST(LeastSnapDurations, AreBetterThanEqualAndTrapezoidalOnes) {
  std::mt19937 random(3);
  double gain = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const int n = 2 + trial % 8;
    const FlatReference start = at_rest({0, 0, 1});
    const auto waypoints = some_prescribed(random, n);
    std::vector<double> trapezoid = trapezoid_durations(start, waypoints, SpeedProfile());
    const double total = sum(trapezoid);
    const std::vector<double> equal(static_cast<std::size_t>(n), total / n);
    const auto best = least_snap_durations(start, waypoints, total);
    ASSERT_TRUE(best.ok());
    EXPECT_NEAR(sum(*best), total, 1e-9 * total);
    const double least = cost(start, waypoints, *best);
    EXPECT_LE(least, cost(start, waypoints, equal) * (1 + 1e-9)) << trial;
    EXPECT_LE(least, cost(start, waypoints, trapezoid) * (1 + 1e-9)) << trial;
    gain += cost(start, waypoints, trapezoid) / least / 60;
  }
  EXPECT_GT(gain, 1.5);  // the mean over all
}

TEST(LeastSnapDurations, NoOthersAreBetter) {
  std::mt19937 random(4);
  std::normal_distribution<double> n;
  for (int trial = 0; trial < 30; ++trial) {
    const FlatReference start = trial % 2 == 0 ? at_rest({0, 0, 1}) : moving(random, 0.5, 0.5);
    const auto waypoints = random_waypoints(random, 2 + trial % 6, 3.0);
    const auto best = least_snap_durations(start, waypoints, 10.0);
    ASSERT_TRUE(best.ok());
    const double least = cost(start, waypoints, *best);
    for (const double size : {0.1, 0.01, 0.001}) {
      for (int direction = 0; direction < 20; ++direction) {
        auto other = *best;
        for (double& duration : other) duration *= std::exp(size * n(random));
        const double total = sum(other);
        for (double& duration : other) duration *= 10.0 / total;
        ASSERT_GE(cost(start, waypoints, other), least * (1 - 1e-8)) << trial << " " << size;
      }
    }
  }
}

TEST(LeastSnapDurations, AllPiecesHaveTheSameSlope) {
  std::mt19937 random(5);
  const auto waypoints = random_waypoints(random, 12, 3.0);
  const auto best = least_snap_durations(at_rest({0, 0, 1}), waypoints, 20.0);
  ASSERT_TRUE(best.ok());
  const auto trajectory = *minimum_snap(Time{}, at_rest({0, 0, 1}), waypoints, *best);
  const auto slopes = snap_cost_slopes(trajectory, kYawWeight);
  // From rest to rest the cost goes with the seventh power of the time.
  const double expected = -7.0 * snap_cost(trajectory, kYawWeight) / 20.0;
  for (const double slope : slopes) EXPECT_NEAR(slope, expected, 1e-3 * std::abs(expected));
}

TEST(LeastSnapDurations, AreSymmetricWhereTheWayIs) {
  const std::vector<Waypoint> there_and_back{
      {{1, 0, 1}, 0}, {{2, 1, 1}, 0}, {{3, 1, 1}, 0}, {{4, 0, 1}, 0}, {{5, 0, 1}, 0}};
  const auto best = least_snap_durations(at_rest({0, 0, 1}), there_and_back, 12.0);
  ASSERT_TRUE(best.ok());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR((*best)[i], (*best)[4 - i], 1e-4) << i;
}

TEST(LeastSnapDurations, DoNotDependOnUnits) {
  // The shares of a way ten times as long, in a time three times as long, are the same.
  std::mt19937 random(6);
  auto waypoints = random_waypoints(random, 5, 1.0);
  for (Waypoint& waypoint : waypoints) waypoint.yaw = 0.0;
  const auto small = least_snap_durations(at_rest({0, 0, 0}), waypoints, 5.0);
  for (Waypoint& waypoint : waypoints) waypoint.position *= 10.0;
  const auto large = least_snap_durations(at_rest({0, 0, 0}), waypoints, 15.0);
  ASSERT_TRUE(small.ok() && large.ok());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(3.0 * (*small)[i], (*large)[i], 1e-3);
}

TEST(LeastSnapDurations, AreFoundWhereThereIsNothingToFly) {
  // Standing still costs nothing, however the time is shared.
  const std::vector<Waypoint> here(3, {{1, 2, 1}, 0.0});
  const auto best = least_snap_durations(at_rest({1, 2, 1}), here, 6.0);
  ASSERT_TRUE(best.ok());
  for (const double duration : *best) EXPECT_NEAR(duration, 2.0, 1e-9);
  // A turn on the spot needs time of its own.
  const std::vector<Waypoint> turn{{{2, 0, 1}, 0.0}, {{2, 0, 1}, 2.0}, {{4, 0, 1}, 2.0}};
  const auto turned = least_snap_durations(at_rest({0, 0, 1}), turn, 9.0);
  ASSERT_TRUE(turned.ok());
  EXPECT_GT((*turned)[1], 1.0);
}

TEST(LeastSnapDurations, SayWhyNot) {
  EXPECT_FALSE(least_snap_durations(at_rest({0, 0, 1}), {}, 5.0).ok());
  EXPECT_FALSE(least_snap_durations(at_rest({0, 0, 1}), {{{1, 0, 1}, 0.0}}, -1.0).ok());
  EXPECT_FALSE(least_snap_durations(at_rest({0, 0, 1}), {{{1, 0, 1}, 0.0}}, std::nan("")).ok());
  EXPECT_FALSE(least_snap_durations(at_rest({0, 0, 1}), {{{1, std::nan(""), 1}, 0.0}}, 5.0).ok());
}

}  // namespace
}  // namespace swiftlet
