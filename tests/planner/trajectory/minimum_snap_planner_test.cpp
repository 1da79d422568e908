// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/minimum_snap_planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/planner/trajectory/random_waypoints.hpp"
#include "tests/planner/trajectory/sampled_extrema.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet {
namespace {

using test::at_rest;
using test::moving;
using test::random_waypoints;

using test::sampled_extrema;

constexpr int kSamples = 60;  // of a piece

/// Every limit at random.
TrajectoryLimits random_limits(std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  TrajectoryLimits limits;
  limits.max_speed = uniform(0.3, 4.0);
  limits.max_acceleration = uniform(0.3, 4.0);
  // Any of the others, also none.
  if (random() % 2 == 0) limits.max_thrust_per_mass = kGravity + uniform(0.3, 4.0);
  if (random() % 2 == 0) limits.min_thrust_per_mass = kGravity - uniform(0.3, 4.0);
  if (random() % 2 == 0) limits.max_body_rate = uniform(0.6, 3.0);
  if (random() % 2 == 0) limits.max_yaw_rate = uniform(0.6, 2.0);
  return limits;
}

/// Samples of every piece keep the limits, but for rounding.
void expect_kept(const Trajectory& trajectory, const TrajectoryLimits& limits) {
  constexpr double kRounding = 1e-9;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    const TrajectoryExtrema seen = sampled_extrema(segment, kSamples);
    ASSERT_LE(seen.max_speed, limits.max_speed * (1 + kRounding));
    ASSERT_LE(seen.max_acceleration, limits.max_acceleration * (1 + kRounding));
    ASSERT_LE(seen.max_thrust_per_mass, limits.max_thrust_per_mass * (1 + kRounding));
    ASSERT_GE(seen.min_thrust_per_mass, limits.min_thrust_per_mass * (1 - kRounding));
    ASSERT_LE(seen.max_body_rate, limits.max_body_rate * (1 + kRounding));
    ASSERT_LE(seen.max_yaw_rate, limits.max_yaw_rate * (1 + kRounding));
  }
}

/// The derivatives at all knots are continuous, to 1e-9 of their scale.
void expect_smooth(const Trajectory& trajectory, int orders) {
  const auto& segments = trajectory.segments();
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    for (int axis = 0; axis < 4; ++axis) {
      for (int order = 0; order <= orders; ++order) {
        double scale = 1e-3;
        for (int k = 0; k <= 8; ++k) {
          scale = std::max({scale, std::abs(derivative(segments[i], axis, k / 8.0, order)),
                            std::abs(derivative(segments[i + 1], axis, k / 8.0, order))});
        }
        ASSERT_NEAR(derivative(segments[i], axis, 1.0, order),
                    derivative(segments[i + 1], axis, 0.0, order), 1e-9 * scale)
            << "knot " << i + 1 << " axis " << axis << " order " << order;
      }
    }
  }
}

TEST(MinimumSnapPlanner, ATrajectoryCanBeLeftForAnotherAtAnyMoment) {
  // What replanning does: from any moment of a trajectory on to other waypoints.
  std::mt19937 random(6);
  std::uniform_real_distribution<double> moment(0.05, 0.95);
  const MinimumSnapPlanner planner;
  int done = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const auto first = planner.plan(Time{}, at_rest({0, 0, 1}), random_waypoints(random, 3, 4.0));
    ASSERT_TRUE(first.ok());
    const Time change{from_seconds(moment(random) * to_seconds(first->duration()))};
    const FlatReference start = first->evaluate(change);
    const auto second = planner.plan(change, start, random_waypoints(random, 3, 4.0));
    if (!second.ok()) continue;
    ++done;
    EXPECT_LE(second->max_speed(), 1.0);
    EXPECT_LE(second->max_acceleration(), 1.0);
    EXPECT_LT((second->evaluate(change).jerk - start.jerk).norm(), 1e-6);
  }
  EXPECT_GE(done, 495);
}

TEST(MinimumSnapPlanner, TenThousandTrajectoriesKeepTheirLimits) {
  std::mt19937 random(4);
  int from_rest_failed = 0, moving_ok = 0, moving_failed = 0;
  constexpr int kTrials = 10000 / test::kSlowdown;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    MinimumSnapPlanner::Params params;
    params.limits = random_limits(random);
    if (trial % 20 == 1) params.timing = Timing::kLeastSnap;
    const bool rest = trial % 4 != 0;
    const FlatReference start =
        rest ? at_rest({0, 0, 1})
             : moving(random, 0.8 * params.limits.max_speed, 0.5 * params.limits.max_acceleration);
    if (!rest && usage(extrema(start), params.limits) > 1.0) continue;
    const int n = trial % 100 == 50 ? 30 : 1 + static_cast<int>(random() % 6);
    const auto result =
        MinimumSnapPlanner(params).plan(Time{}, start, random_waypoints(random, n, 5.0));
    if (!result.ok()) {
      ++(rest ? from_rest_failed : moving_failed);
      continue;
    }
    moving_ok += !rest;
    ASSERT_NO_FATAL_FAILURE(expect_kept(*result, params.limits));
    // A first piece that ends the acceleration of the start joins the others up to the jerk.
    ASSERT_NO_FATAL_FAILURE(expect_smooth(*result, rest ? 6 : 3));
    const FlatReference first = result->evaluate(Time{});
    ASSERT_LT((first.velocity - start.velocity).norm(), 1e-6);
    ASSERT_LT((first.acceleration - start.acceleration).norm(), 1e-6);
  }
  EXPECT_EQ(from_rest_failed, 0);
  EXPECT_GT(moving_ok, kTrials / 10);
  EXPECT_LT(moving_failed, moving_ok / 10);
}

TEST(MinimumSnapPlanner, KeepsLimitsAndWhatWaypointsPrescribe) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  int done = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    MinimumSnapPlanner::Params params;
    params.limits = random_limits(random);
    params.timing = trial % 2 == 0 ? Timing::kFast : Timing::kLeastSnap;
    auto waypoints = random_waypoints(random, 1 + static_cast<int>(random() % 5), 5.0);
    const std::size_t passed = random() % waypoints.size();
    waypoints[passed].velocity = 0.4 * params.limits.max_speed * direction();
    const auto result = MinimumSnapPlanner(params).plan(Time{}, at_rest({0, 0, 1}), waypoints);
    if (!result.ok()) continue;
    ++done;
    ASSERT_NO_FATAL_FAILURE(expect_kept(*result, params.limits));
    ASSERT_NO_FATAL_FAILURE(expect_smooth(*result, 3));
    const FlatReference at = test::moment_of(result->segments()[passed], 1.0);
    ASSERT_LT((at.velocity - *waypoints[passed].velocity).norm(), 1e-9);
  }
  // Not everything that is prescribed can be flown.
  EXPECT_GT(done, kTrials * 8 / 10);
}

TEST(MinimumSnapPlanner, UsesUpTheLimitThatCounts) {
  // One limit after the other is made the one that the duration depends on.
  std::mt19937 random(9);
  for (int trial = 0; trial < 100; ++trial) {
    MinimumSnapPlanner::Params params;
    params.reserve = 0.0;
    params.timing = trial % 2 == 0 ? Timing::kFast : Timing::kLeastSnap;
    params.limits.max_speed = params.limits.max_acceleration = 50.0;
    const int which = trial % 6;
    if (which == 0) params.limits.max_speed = 1.0;
    if (which == 1) params.limits.max_acceleration = 1.0;
    if (which == 2) params.limits.max_thrust_per_mass = 11.0;
    if (which == 3) params.limits.min_thrust_per_mass = 8.5;
    if (which == 4) params.limits.max_body_rate = 0.8;
    if (which == 5) params.limits.max_yaw_rate = 0.5;
    const auto result = MinimumSnapPlanner(params).plan(Time{}, at_rest({0, 0, 1}),
                                                        random_waypoints(random, 4, 3.0));
    ASSERT_TRUE(result.ok()) << result.error().reason;
    const double used = usage(extrema(*result), params.limits);
    EXPECT_LE(used, 1.0) << which;
    EXPECT_GT(used, 0.9) << which;
  }
}

TEST(MinimumSnapPlanner, LeastSnapCostsLessInTheSameTime) {
  std::mt19937 random(10);
  double gain = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    const auto waypoints = random_waypoints(random, 5, 4.0);
    const auto fast = MinimumSnapPlanner().plan(Time{}, at_rest({0, 0, 1}), waypoints);
    ASSERT_TRUE(fast.ok());
    MinimumSnapPlanner::Params wide;
    wide.limits.max_speed = wide.limits.max_acceleration = 100.0;
    const auto smooth = MinimumSnapPlanner(wide).plan_for(Time{}, at_rest({0, 0, 1}), waypoints,
                                                          to_seconds(fast->duration()));
    ASSERT_TRUE(smooth.ok());
    EXPECT_NEAR(to_seconds(smooth->duration()), to_seconds(fast->duration()), 1e-6);
    EXPECT_LE(snap_cost(*smooth, 0.1), snap_cost(*fast, 0.1) * (1 + 1e-9));
    gain += snap_cost(*fast) / snap_cost(*smooth) / 50;
  }
  EXPECT_GT(gain, 1.2);
}

TEST(MinimumSnapPlanner, FliesTheOvalOfSeed000InItsNineSeconds) {
  const Eigen::Vector3d p1(-1, -1.5, 1.2), p2(0, -0.5, 1.2), p3(0, 0.5, 1.2);
  const std::vector<Waypoint> oval{{p2, 0.0}, {p3, 0.0}, {p1, 0.0}};
  MinimumSnapPlanner::Params params;
  params.limits.max_speed = 1.5;
  params.limits.max_acceleration = 2.0;
  const auto trajectory = MinimumSnapPlanner(params).plan_for(Time{}, at_rest(p1), oval, 9.0);
  ASSERT_TRUE(trajectory.ok());
  EXPECT_NEAR(to_seconds(trajectory->duration()), 9.0, 1e-6);
  // "The velocity reaches values of 1 m/s."
  EXPECT_NEAR(trajectory->max_speed(), 1.0, 0.3);

  params.limits.max_speed = 0.8;
  const auto slower = MinimumSnapPlanner(params).plan_for(Time{}, at_rest(p1), oval, 9.0);
  ASSERT_FALSE(slower.ok());
  EXPECT_THAT(slower.error().reason, testing::HasSubstr("the speed reaches"));
  EXPECT_THAT(slower.error().reason, testing::HasSubstr("above the limit of 0.8 m/s"));
  EXPECT_THAT(slower.error().reason, testing::HasSubstr("it would have to take"));
  // That is how long it takes.
  const double needed = 9.0 * trajectory->max_speed() / 0.8;
  EXPECT_TRUE(MinimumSnapPlanner(params).plan_for(Time{}, at_rest(p1), oval, 1.001 * needed).ok());
  EXPECT_FALSE(MinimumSnapPlanner(params).plan_for(Time{}, at_rest(p1), oval, 0.999 * needed).ok());
}

TEST(MinimumSnapPlanner, UsesTheLimitsThatItHas) {
  // 20 m in a line at 1 m/s and 1 m/s^2 take 21 s at the least.
  std::vector<Waypoint> line;
  for (int i = 1; i <= 20; ++i) line.push_back({{1.0 * i, 0, 1}, 0.0});
  const auto result = MinimumSnapPlanner().plan(Time{}, at_rest({0, 0, 1}), line);
  ASSERT_TRUE(result.ok());
  EXPECT_GT(to_seconds(result->duration()), 21.0);
  EXPECT_LT(to_seconds(result->duration()), 21.0 * 1.35);
}

TEST(MinimumSnapPlanner, SaysWhyNot) {
  const MinimumSnapPlanner planner;
  FlatReference fast = at_rest({0, 0, 1});
  fast.velocity.x() = 1.5;
  const auto too_fast = planner.plan(Time{}, fast, {{{5, 0, 1}, 0.0}});
  ASSERT_FALSE(too_fast.ok());
  EXPECT_THAT(too_fast.error().reason, testing::HasSubstr("1.5 m/s"));
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, 1}), {}).ok());
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, std::nan("")}), {{{5, 0, 1}, 0.0}}).ok());
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, 1}), {{{5, std::nan(""), 1}, 0.0}}).ok());
  EXPECT_FALSE(minimum_snap(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0.0}}, {-1.0}).ok());
  EXPECT_FALSE(minimum_snap(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0.0}}, {1.0, 1.0}).ok());
  Waypoint quick{{5, 0, 1}, 0.0};
  quick.velocity = Eigen::Vector3d(2.0, 0.0, 0.0);
  const auto prescribed = planner.plan(Time{}, at_rest({0, 0, 1}), {{{2, 0, 1}, 0.0}, quick});
  ASSERT_FALSE(prescribed.ok());
  EXPECT_THAT(prescribed.error().reason, testing::HasSubstr("at waypoint 2 the speed reaches 2"));
  EXPECT_FALSE(planner.plan_for(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0.0}}, -1.0).ok());
  MinimumSnapPlanner::Params params;
  params.limits.max_thrust_per_mass = 9.0;
  EXPECT_FALSE(MinimumSnapPlanner(params).plan(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0}}).ok());
  params.limits = {};
  params.limits.max_speed = std::nan("");
  EXPECT_FALSE(MinimumSnapPlanner(params).plan(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0}}).ok());
}

TEST(MinimumSnapPlanner, AWaypointWhereItStandsAlreadyIsNoTrouble) {
  const auto result = MinimumSnapPlanner().plan(Time{}, at_rest({1, 2, 1}), {{{1, 2, 1}, 0.0}});
  ASSERT_TRUE(result.ok());
  EXPECT_LT((result->final_reference().position - Eigen::Vector3d(1, 2, 1)).norm(), 1e-12);
}

}  // namespace
}  // namespace swiftlet
