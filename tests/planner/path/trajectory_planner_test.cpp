// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/trajectory_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"
#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

constexpr std::uint32_t kSeed = 1;
constexpr double kPi = 3.14159265358979323846;

FlatReference at_rest(const Eigen::Vector3d& position, double yaw = 0.0) {
  FlatReference start;
  start.position = position;
  start.yaw = yaw;
  return start;
}

template <class Visit>
void every(const Trajectory& trajectory, double step_s, Visit visit) {
  const double T = to_seconds(trajectory.duration());
  for (double t = 0.0; t <= T; t += step_s) {
    visit(t, trajectory.evaluate(trajectory.start() + from_seconds(t)));
  }
}

TEST(TrajectoryPlanner, KeepsClearanceAndLimitsThroughRandomFields) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.6, 7.4);
  const TrajectoryPlanner planner;
  int flown = 0, straight = 0;
  for (int trial = 0; trial < 800; ++trial) {
    const OccupancyGrid grid = test::random_field(random, 8.0);
    const Eigen::Vector3d start(place(random), place(random), 1.0);
    const FlightGoal goal{{place(random), place(random), 1.4}, 0.0};
    const auto map = planner.path_planner().make_map(grid, start.head<2>());
    ASSERT_TRUE(map.ok());
    if (map->clearance_at(start.head<2>()) < 0.35) continue;
    const TrajectoryResult result = planner.plan(*map, Time{}, at_rest(start), goal, kSeed);
    // From rest, a path is enough for a trajectory.
    ASSERT_NE(result.failure, PlanFailure::kNoTrajectory) << trial << ": " << result.reason;
    if (!result.ok()) continue;
    ++flown;
    straight += result.straight_legs;
    every(result.trajectory, 0.02, [&](double t, const FlatReference& reference) {
      ASSERT_GE(map->clearance_at(reference.position.head<2>()), 0.35 - 0.4 * grid.resolution())
          << trial << " after " << t;
      ASSERT_LE(reference.velocity.norm(), 1.0 + 1e-9);
      ASSERT_LE(reference.acceleration.norm(), 1.0 + 1e-9);
    });
    EXPECT_LT((result.trajectory.final_reference().position - goal.position).norm(), 1e-9);
  }
  EXPECT_GT(flown, 200);
  // The slow way is the exception.
  EXPECT_LT(straight, flown / 50);
}

TEST(TrajectoryPlanner, FliesThroughTheMiddleOfDoorways) {
  const OccupancyGrid grid = test::office();
  const TrajectoryResult result =
      TrajectoryPlanner().plan(grid, Time{}, at_rest({1, 1, 1}), {{3, 9, 1}, 0.0}, kSeed);
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_FALSE(result.straight_legs);
  bool lower = false, upper = false;
  every(result.trajectory, 0.005, [&](double, const FlatReference& reference) {
    const Eigen::Vector3d& p = reference.position;
    if (p.y() > 4.0 && p.y() < 4.1) {
      EXPECT_NEAR(p.x(), 2.45, 0.05);
      lower = true;
    }
    if (p.y() > 6.0 && p.y() < 6.1) {
      EXPECT_NEAR(p.x(), 12.45, 0.05);
      upper = true;
    }
  });
  EXPECT_TRUE(lower && upper);
  // 25.8 m at most 1 m/s: not much more than a minute of patience.
  EXPECT_LT(to_seconds(result.trajectory.duration()), 1.5 * result.path.length);
}

TEST(TrajectoryPlanner, ClimbsOnTheWayAndStraightUp) {
  const OccupancyGrid grid = test::hall(8, 8);
  const TrajectoryResult slope =
      TrajectoryPlanner().plan(grid, Time{}, at_rest({1, 1, 0.8}), {{6, 6, 1.8}, 0.0}, kSeed);
  ASSERT_TRUE(slope.ok());
  every(slope.trajectory, 0.05, [&](double, const FlatReference& reference) {
    EXPECT_GT(reference.position.z(), 0.8 - 0.02);
    EXPECT_LT(reference.position.z(), 1.8 + 0.02);
  });
  const TrajectoryResult up =
      TrajectoryPlanner().plan(grid, Time{}, at_rest({2, 2, 0.8}), {{2, 2, 1.8}, 0.0}, kSeed);
  ASSERT_TRUE(up.ok()) << up.reason;
  EXPECT_NEAR(up.trajectory.final_reference().position.z(), 1.8, 1e-9);
  every(up.trajectory, 0.05, [&](double, const FlatReference& reference) {
    EXPECT_LT((reference.position.head<2>() - Eigen::Vector2d(2, 2)).norm(), 0.05);
  });
}

TEST(TrajectoryPlanner, YawFollowsItsPolicy) {
  const OccupancyGrid grid = test::hall(8, 8);
  TrajectoryPlanner::Params params;
  const auto plan = [&](YawPolicy policy) {
    params.yaw = policy;
    const auto result = TrajectoryPlanner(params).plan(grid, Time{}, at_rest({1, 1, 1}, 0.5),
                                                       {{1, 7, 1}, -1.0}, kSeed);
    EXPECT_TRUE(result.ok()) << result.reason;
    return result.trajectory;
  };
  every(plan(YawPolicy::kHold), 0.05,
        [](double, const FlatReference& reference) { EXPECT_NEAR(reference.yaw, 0.5, 1e-9); });
  EXPECT_NEAR(wrap_angle(plan(YawPolicy::kAlongPath).final_reference().yaw - kPi / 2), 0.0, 0.05);
  EXPECT_NEAR(wrap_angle(plan(YawPolicy::kGoal).final_reference().yaw + 1.0), 0.0, 1e-9);
}

TEST(TrajectoryPlanner, StartsInFlight) {
  const OccupancyGrid grid = test::hall(8, 8);
  FlatReference start = at_rest({2, 2, 1});
  start.velocity = {0.6, 0.0, 0.0};
  start.acceleration = {0.0, 0.3, 0.0};
  start.jerk = {0.1, -0.2, 0.0};
  const Time now(from_seconds(100.0));
  const auto result = TrajectoryPlanner().plan(grid, now, start, {{6, 6, 1}, 0.0}, kSeed);
  ASSERT_TRUE(result.ok()) << result.reason;
  const FlatReference first = result.trajectory.evaluate(now);
  EXPECT_LT((first.position - start.position).norm(), 1e-9);
  EXPECT_LT((first.velocity - start.velocity).norm(), 1e-9);
  EXPECT_LT((first.acceleration - start.acceleration).norm(), 1e-9);
  EXPECT_LT((first.jerk - start.jerk).norm(), 1e-8);
}

TEST(TrajectoryPlanner, SaysThatItCannotEvadeInFlight) {
  // Towards a wall at almost full speed, half a metre before it.
  const OccupancyGrid grid = test::hall(8, 8);
  FlatReference start = at_rest({7.4, 4, 1});
  start.velocity = {0.95, 0.0, 0.0};
  const auto result = TrajectoryPlanner().plan(grid, Time{}, start, {{1, 4, 1}, 0.0}, kSeed);
  EXPECT_EQ(result.failure, PlanFailure::kNoTrajectory);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_TRUE(result.trajectory.empty());
}

TEST(TrajectoryPlanner, LeavesAWallThatItIsTooNearTo) {
  const OccupancyGrid grid = test::hall(6, 6);
  const auto result =
      TrajectoryPlanner().plan(grid, Time{}, at_rest({3, 0.36, 1}), {{3, 5, 1}, 0.0}, kSeed);
  ASSERT_TRUE(result.ok()) << result.reason;
  double reached = 0.0;
  every(result.trajectory, 0.02, [&](double, const FlatReference& reference) {
    const double here = test::true_clearance(grid, reference.position.head<2>());
    EXPECT_GE(here, std::min(0.35, reached) - 0.03);
    reached = std::max(reached, here);
  });
}

TEST(TrajectoryPlanner, HostileInputIsRefusedInWords) {
  const OccupancyGrid grid = test::hall(4, 4);
  const TrajectoryPlanner planner;
  const double nan = std::nan("");
  const FlatReference good = at_rest({1, 1, 1});
  FlatReference bad = good;
  bad.jerk.x() = nan;
  for (const TrajectoryResult& result :
       {planner.plan(grid, Time{}, at_rest({nan, 1, 1}), {{2, 2, 1}, 0}, kSeed),
        planner.plan(grid, Time{}, at_rest({1, 1, nan}), {{2, 2, 1}, 0}, kSeed),
        planner.plan(grid, Time{}, good, {{2, nan, 1}, 0}, kSeed),
        planner.plan(grid, Time{}, good, {{2, 2, nan}, 0}, kSeed),
        planner.plan(grid, Time{}, good, {{2, 2, 1}, nan}, kSeed),
        planner.plan(grid, Time{}, bad, {{2, 2, 1}, 0}, kSeed),
        planner.plan(OccupancyGrid(), Time{}, good, {{2, 2, 1}, 0}, kSeed)}) {
    EXPECT_FALSE(result.ok());
    EXPECT_FALSE(result.reason.empty());
    EXPECT_TRUE(result.trajectory.empty());
  }
}

TEST(FirstConflict, FindsTheMomentThatAWallIsReached) {
  OccupancyGrid grid = test::hall(8, 8);
  const auto free =
      TrajectoryPlanner().plan(grid, Time{}, at_rest({1, 4, 1}), {{7, 4, 1}, 0}, kSeed);
  ASSERT_TRUE(free.ok());
  const auto before = ClearanceMap::make(grid, {});
  EXPECT_FALSE(first_conflict(free.trajectory, Time{}, *before, 0.35, 0.0).has_value());
  test::paint(grid, 5.0, 3, 5.2, 5, CellState::kOccupied);
  const auto after = ClearanceMap::make(grid, {});
  const auto conflict = first_conflict(free.trajectory, Time{}, *after, 0.35, 0.0);
  ASSERT_TRUE(conflict.has_value());
  EXPECT_NEAR(free.trajectory.evaluate(*conflict).position.x(), 5.0 - 0.35, 0.04);
  // What is behind does not matter any more.
  const Time late = free.trajectory.end() - std::chrono::milliseconds(500);
  EXPECT_FALSE(first_conflict(free.trajectory, late, *after, 0.35, 0.0).has_value());
}

TEST(FirstConflict, ExcusesABeginningTooNearOnlyWhileItGetsNoNearer) {
  // 0.30 m from the wall at y = 0.1, where 0.35 m are needed: x is constant, y a straight line.
  const OccupancyGrid grid = test::hall(6, 6);
  const auto map = ClearanceMap::make(grid, {});
  ASSERT_TRUE(map.ok());
  const auto line = [](double y_end) {
    TrajectorySegment segment;
    segment.duration_s = 2.0;
    segment.coefficients[kX][0] = 3.0;
    segment.coefficients[kY][0] = 0.40;
    segment.coefficients[kY][1] = y_end - 0.40;
    return Trajectory(Time{}, {segment});
  };
  EXPECT_FALSE(first_conflict(line(1.5), Time{}, *map, 0.35, 0.4).has_value());
  const auto nearer = first_conflict(line(0.30), Time{}, *map, 0.35, 0.4);
  ASSERT_TRUE(nearer.has_value());
  EXPECT_LT(to_seconds(*nearer), 1.2);
  // Along the wall, the excuse ends with the escape distance.
  TrajectorySegment along = line(0.40).segments()[0];
  along.coefficients[kX][1] = 2.0;
  const auto late = first_conflict(Trajectory(Time{}, {along}), Time{}, *map, 0.35, 0.4);
  ASSERT_TRUE(late.has_value());
  EXPECT_NEAR(to_seconds(*late), 0.4, 0.05);
  EXPECT_TRUE(first_conflict(line(1.5), Time{}, *map, 0.35, 0.0).has_value());
}

}  // namespace
}  // namespace swiftlet
