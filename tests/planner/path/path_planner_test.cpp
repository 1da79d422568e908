// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/path_planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

#include "tests/planner/path/maps.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kSeed = 1;

/// Points every centimetre along a path.
std::vector<Eigen::Vector2d> points_along(const Path& path) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Eigen::Vector2d leg = path.points[i + 1] - path.points[i];
    const int n = 1 + static_cast<int>(leg.norm() / 0.01);
    for (int k = 0; k <= n; ++k) points.push_back(path.points[i] + leg * (1.0 * k / n));
  }
  return points;
}

/// Where the path crosses the line y = `y`.
std::vector<double> crossings(const Path& path, double y) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Eigen::Vector2d a = path.points[i], b = path.points[i + 1];
    if ((a.y() - y) * (b.y() - y) < 0) {
      result.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
  }
  return result;
}

TEST(PathPlanner, ThousandsOfRandomMapsAgreeWithDijkstra) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.6, 7.4);
  PathPlanner::Params params;
  params.cost.clearance_weight = 0.0;  // shortest, to compare lengths
  params.cost.unknown_weight = 0.0;
  params.border = 0.0;
  const PathPlanner planner(params);
  int found = 0, blocked = 0;
  constexpr int kTrials = 1000 / test::kSlowdown;
  for (int trial = 0; trial < kTrials; ++trial) {
    const OccupancyGrid grid = test::random_field(random, 8.0);
    const Eigen::Vector2d start(place(random), place(random)), goal(place(random), place(random));
    const auto map = planner.make_map(grid, start);
    ASSERT_TRUE(map.ok());
    const double hard = params.cost.hard_clearance();
    // Start and goal clear of the borderline, which the oracle decides by centres of cells.
    if (map->clearance_at(start) < hard + 0.06 || map->clearance_at(goal) < hard + 0.06) continue;
    const PathResult result = planner.plan(*map, start, goal, static_cast<std::uint32_t>(trial));
    const double oracle =
        test::dijkstra_length(*map, map->cell_of(start), map->cell_of(goal), hard);
    ASSERT_EQ(result.ok(), std::isfinite(oracle)) << trial << ": " << result.reason;
    if (!result.ok()) {
      EXPECT_EQ(result.failure, PlanFailure::kNoPath);
      ++blocked;
      continue;
    }
    ++found;
    EXPECT_EQ(result.path.points.front(), start);
    EXPECT_EQ(result.path.points.back(), goal);
    EXPECT_LE(result.path.length, 1.05 * oracle + 0.1) << trial;
    EXPECT_NEAR(result.path.cost, result.path.length, 1e-6 * result.path.length);
    for (const Eigen::Vector2d& p : points_along(result.path)) {
      ASSERT_GE(map->clearance_at(p), hard - 0.3 * grid.resolution()) << trial;
    }
    if (trial % 25 == 0) {
      for (const Eigen::Vector2d& p : points_along(result.path)) {
        ASSERT_GE(test::true_clearance(grid, p), hard - 0.5 * grid.resolution()) << trial;
      }
    }
  }
  EXPECT_GT(found, kTrials * 3 / 10);
  EXPECT_GE(blocked, kTrials / 40);
}

TEST(PathPlanner, CrossesDoorwaysThroughTheMiddle) {
  const OccupancyGrid grid = test::office();
  const PathPlanner planner;
  const Eigen::Vector2d starts[] = {{1, 1}, {4.3, 3.4}, {0.7, 3.4}, {2.4, 0.6}, {4.0, 1.0}};
  for (const Eigen::Vector2d& start : starts) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const PathResult result = planner.plan(grid, start, {3, 9}, seed);
      ASSERT_TRUE(result.ok()) << result.reason;
      for (const double y : {4.0, 4.05, 4.1}) {
        const auto lower = crossings(result.path, y);
        ASSERT_EQ(lower.size(), 1U);
        EXPECT_NEAR(lower[0], 2.45, 0.05) << start.transpose();
      }
      for (const double y : {6.0, 6.05, 6.1}) {
        const auto upper = crossings(result.path, y);
        ASSERT_EQ(upper.size(), 1U);
        EXPECT_NEAR(upper[0], 12.45, 0.05) << start.transpose();
      }
    }
  }
}

TEST(PathPlanner, KeepsThePreferredClearanceWhereThereIsRoom) {
  // A pillar in the way: the shortest way touches its inflation, the preferred one does not.
  OccupancyGrid grid = test::hall(8, 8);
  test::paint(grid, 3.8, 3.8, 4.2, 4.2, CellState::kOccupied);
  PathPlanner::Params params;
  const PathResult wide = PathPlanner(params).plan(grid, {1.5, 4.01}, {6.5, 4.01}, kSeed);
  params.cost.clearance_weight = 0.0;
  const PathResult tight = PathPlanner(params).plan(grid, {1.5, 4.01}, {6.5, 4.01}, kSeed);
  ASSERT_TRUE(wide.ok() && tight.ok());
  const auto nearest = [&](const Path& path) {
    double d = 1e9;
    for (const auto& p : points_along(path)) d = std::min(d, test::true_clearance(grid, p));
    return d;
  };
  EXPECT_LT(nearest(tight.path), 0.45);
  EXPECT_GT(nearest(wide.path), 0.60);
  EXPECT_LT(wide.path.length, 1.15 * tight.path.length);
}

TEST(PathPlanner, PrefersKnownSpaceAndDaresUnknownSpace) {
  OccupancyGrid grid = test::hall(10, 6);
  test::paint(grid, 3, 0.1, 7, 3, CellState::kUnknown);
  PathPlanner::Params params;
  params.cost.unknown_weight = 0.0;
  const PathResult indifferent = PathPlanner(params).plan(grid, {1, 2.8}, {9, 2.8}, kSeed);
  params.cost.unknown_weight = 1.0;
  const PathResult wary = PathPlanner(params).plan(grid, {1, 2.8}, {9, 2.8}, kSeed);
  ASSERT_TRUE(indifferent.ok() && wary.ok());
  EXPECT_GT(indifferent.path.unknown_length, 3.5);
  EXPECT_LT(wary.path.unknown_length, 0.2);

  test::paint(grid, 3, 0.1, 7, 5.9, CellState::kUnknown);
  const PathResult daring = PathPlanner(params).plan(grid, {1, 2.8}, {9, 2.8}, kSeed);
  ASSERT_TRUE(daring.ok());
  EXPECT_NEAR(daring.path.unknown_length, 4.0, 0.1);
  params.cost.unknown_is_free = false;
  EXPECT_EQ(PathPlanner(params).plan(grid, {1, 2.8}, {9, 2.8}, kSeed).failure,
            PlanFailure::kNoPath);
}

TEST(PathPlanner, GoesBeyondTheMapWhereUnknownIsFree) {
  OccupancyGrid grid({}, {0, 0}, 80, 80);
  test::paint(grid, 0, 0, 4, 4, CellState::kFree);
  const PathResult result = PathPlanner().plan(grid, {1, 1}, {7, -2}, kSeed);
  ASSERT_TRUE(result.ok()) << result.reason;
  // A little bent, since known space is cheaper.
  EXPECT_NEAR(result.path.length, std::hypot(6.0, 3.0), 0.15);
  EXPECT_EQ(PathPlanner().plan(grid, {1, 1}, {1e5, 1e5}, kSeed).failure,
            PlanFailure::kGoalOutsideMap);
  PathPlanner::Params params;
  params.cost.unknown_is_free = false;
  EXPECT_EQ(PathPlanner(params).plan(grid, {1, 1}, {7, -2}, kSeed).failure,
            PlanFailure::kGoalOutsideMap);
}

TEST(PathPlanner, AWayBeyondTheMapCostsWhatItWouldOnAMapThatReachesSoFar) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0.6, 7.4), around(-14.0, 22.0);
  const PathPlanner planner;
  const PathPlanner::Params& params = planner.params();
  int ways = 0, closed = 0, behind = 0, from_outside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    OccupancyGrid grid = test::random_field(random, 8.0);
    const double door = inside(random);
    if (trial % 4 != 0) test::paint(grid, 7.85, door - 0.6, 8.1, door + 0.6, CellState::kFree);
    Eigen::Vector2d start(inside(random), inside(random));
    Eigen::Vector2d goal(around(random), around(random));
    if (trial % 5 == 1) std::swap(start, goal);
    if (trial % 5 == 2) start = {around(random), around(random)};
    const auto map = planner.make_map(grid, start);
    const auto far = ClearanceMap::make(grid, params.cost, {start, goal}, params.border);
    ASSERT_TRUE(map.ok() && far.ok());
    if (map->contains(goal) && map->contains(start)) continue;
    ASSERT_TRUE(far->contains(goal) && far->contains(start));
    const PathResult found = planner.plan(*map, start, goal, kSeed);
    const PathResult expected = planner.plan(*far, start, goal, kSeed);
    ASSERT_EQ(found.failure, expected.failure) << trial << ": " << found.reason;
    if (!found.ok()) {
      closed += found.failure == PlanFailure::kNoPath;
      continue;
    }
    ++ways;
    behind += goal.x() < 0.0;
    from_outside += !map->contains(start);
    EXPECT_EQ(found.path.points.front(), start);
    EXPECT_EQ(found.path.points.back(), goal);
    // There the fill makes steps in eight directions; a straight line can be better.
    EXPECT_LE(found.path.cost, 1.03 * expected.path.cost) << trial;
    EXPECT_GE(found.path.cost, 0.92 * expected.path.cost) << trial;
    EXPECT_LE(planner.least_cost(*map, start, goal), 1.005 * found.path.cost) << trial;
    for (const auto& p : points_along(found.path)) {
      if (found.path.escapes) break;
      ASSERT_GE(far->clearance_at(p), params.cost.hard_clearance() - 0.3 * grid.resolution())
          << trial;
    }
  }
  EXPECT_GT(ways, 80);
  EXPECT_GT(closed, 20);
  EXPECT_GT(behind, 20) << "around the outside";
  EXPECT_GT(from_outside, 30);
}

TEST(PathPlanner, GoesNoFartherBeyondTheMapThanIsSaid) {
  OccupancyGrid grid({}, {0, 0}, 80, 80);
  test::paint(grid, 0, 0, 4, 4, CellState::kFree);
  const PathResult far = PathPlanner().plan(grid, {2, 2}, {292, 2}, kSeed);
  ASSERT_TRUE(far.ok()) << far.reason;
  EXPECT_NEAR(far.path.length, 290.0, 0.1);
  const PathResult too_far = PathPlanner().plan(grid, {2, 2}, {312, 2}, kSeed);
  EXPECT_EQ(too_far.failure, PlanFailure::kGoalOutsideMap);
  EXPECT_THAT(too_far.reason, HasSubstr("(312.00, 2.00) is 310 m away"));
}

TEST(PathPlanner, TheSameInputsGiveTheSameBits) {
  const OccupancyGrid grid = test::office();
  const PathPlanner planner;
  const PathResult first = planner.plan(grid, {1, 1}, {3, 9}, 42);
  ASSERT_TRUE(first.ok());
  // Whatever ran before, also with other seeds, and beside it in other threads.
  for (std::uint32_t other = 0; other < 5; ++other) {
    (void)planner.plan(grid, {9, 3}, {13, 3}, other);
    const PathResult again = planner.plan(grid, {1, 1}, {3, 9}, 42);
    ASSERT_EQ(again.path.points, first.path.points);
  }
  std::vector<PathResult> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] { result = planner.plan(grid, {1, 1}, {3, 9}, 42); });
  }
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result.path.points, first.path.points);
}

TEST(PathPlanner, NoSeedMakesItFail) {
  const OccupancyGrid grid = test::office();
  const PathPlanner planner;
  double cheapest = 1e9, dearest = 0.0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const PathResult result = planner.plan(grid, {1, 1}, {3, 9}, seed);
    ASSERT_TRUE(result.ok());
    cheapest = std::min(cheapest, result.path.cost);
    dearest = std::max(dearest, result.path.cost);
  }
  EXPECT_LT(dearest, 1.02 * cheapest);
}

TEST(PathPlanner, TheLeastCostIsBelowEveryPathAndNotByMuch) {
  const OccupancyGrid grid = test::office();
  const PathPlanner planner;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0.6, 14.6), y(0.6, 9.6);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Vector2d start(x(random), y(random)), goal(x(random), y(random));
    const auto map = planner.make_map(grid, start);
    const PathResult result = planner.plan(*map, start, goal, kSeed);
    if (!result.ok() || result.path.escapes || result.path.length < 1.0) continue;
    const double least = planner.least_cost(*map, start, goal);
    EXPECT_LE(least, 1.005 * result.path.cost);
    EXPECT_GE(least, 0.85 * result.path.cost);
    ++compared;
  }
  EXPECT_GT(compared, 20);
  EXPECT_EQ(planner.least_cost(ClearanceMap(), {1, 1}, {2, 2}), 0.0);
}

TEST(PathPlanner, AClosedDoorIsNoPath) {
  OccupancyGrid grid = test::office();
  test::paint(grid, 12, 5.95, 12.9, 6.1, CellState::kOccupied);
  const PathResult result = PathPlanner().plan(grid, {1, 1}, {3, 9}, kSeed);
  EXPECT_EQ(result.failure, PlanFailure::kNoPath);
  EXPECT_THAT(result.reason, HasSubstr("no path from (1.00, 1.00) to (3.00, 9.00)"));
  EXPECT_TRUE(result.path.points.empty());
}

TEST(PathPlanner, ADoorwayIsPassedExactlyWhenTheDiscFits) {
  for (int cells = 8; cells <= 20; ++cells) {
    OccupancyGrid grid = test::hall(8, 6);
    test::paint(grid, 3.95, 0, 4.1, 6, CellState::kOccupied);
    const double width = 0.05 * cells;
    test::paint(grid, 3.9, 3.0, 4.15, 3.0 + width, CellState::kFree);
    const PathResult result = PathPlanner().plan(grid, {1, 2}, {7, 4}, kSeed);
    // The disc of 0.35 m needs 0.70 m; its centre lies on the centres or edges of cells.
    if (width < 0.70 - 1e-9) {
      EXPECT_EQ(result.failure, PlanFailure::kNoPath) << width;
    }
    if (width > 0.75) {
      EXPECT_TRUE(result.ok()) << width << ": " << result.reason;
    }
  }
}

TEST(PathPlanner, NamesTheKindOfFailure) {
  const OccupancyGrid grid = test::office();
  const PathPlanner planner;
  const PathResult goal = planner.plan(grid, {1, 1}, {11, 2}, kSeed);
  EXPECT_EQ(goal.failure, PlanFailure::kGoalInObstacle);
  EXPECT_THAT(goal.reason, HasSubstr("the goal (11.00, 2.00)"));
  EXPECT_EQ(planner.plan(grid, {1, 1}, {3, 3.8}, kSeed).failure, PlanFailure::kGoalInObstacle);
  const PathResult start = planner.plan(grid, {11.25, 1.75}, {1, 1}, kSeed);
  EXPECT_EQ(start.failure, PlanFailure::kStartInContact);
  EXPECT_THAT(start.reason, HasSubstr("the start (11.25, 1.75)"));
}

TEST(PathPlanner, GetsOutOfTheReachOfAWall) {
  // Map noise: the vehicle hovers 0.25 m from a wall and must be 0.35 m away.
  const OccupancyGrid grid = test::hall(6, 6);
  const PathResult result = PathPlanner().plan(grid, {3.0, 0.35}, {3.0, 5.0}, kSeed);
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(result.path.escapes);
  EXPECT_EQ(result.path.points.front(), Eigen::Vector2d(3.0, 0.35));
  double clearance = 0.0;
  for (const auto& p : points_along(result.path)) {
    // Away from the wall from the first centimetre on.
    const double here = test::true_clearance(grid, p);
    EXPECT_GE(here, std::min(0.35, clearance) - 0.01);
    clearance = std::max(clearance, here);
  }
  EXPECT_LT((result.path.points[1] - result.path.points[0]).norm(), 0.2);
  const PathResult clear = PathPlanner().plan(grid, {3.0, 1.0}, {3.0, 5.0}, kSeed);
  EXPECT_FALSE(clear.path.escapes);
}

TEST(PathPlanner, HostileInputIsRefusedInWords) {
  const OccupancyGrid grid = test::hall(4, 4);
  const PathPlanner planner;
  const double odd[] = {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -1e300, 1e17};
  for (const double bad : odd) {
    for (const PathResult& result : {planner.plan(grid, {bad, 1}, {2, 2}, kSeed),
                                     planner.plan(grid, {1, 1}, {2, bad}, kSeed)}) {
      EXPECT_FALSE(result.ok());
      EXPECT_FALSE(result.reason.empty());
      EXPECT_TRUE(result.path.points.empty());
    }
  }
  EXPECT_EQ(planner.plan(OccupancyGrid(), {1, 1}, {2, 2}, kSeed).failure, PlanFailure::kBadInput);
  EXPECT_EQ(planner.plan(ClearanceMap(), {1, 1}, {2, 2}, kSeed).failure, PlanFailure::kBadInput);
  // Where it is already.
  const PathResult here = planner.plan(grid, {2, 2}, {2, 2}, kSeed);
  ASSERT_TRUE(here.ok());
  EXPECT_NEAR(here.path.length, 0.0, 0.1);
  // Without a single sample the fill's own way is flown.
  PathPlanner::Params params;
  params.samples = 0;
  EXPECT_TRUE(PathPlanner(params).plan(test::office(), {1, 1}, {3, 9}, kSeed).ok());
}

}  // namespace
}  // namespace swiftlet
