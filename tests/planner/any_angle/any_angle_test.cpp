// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <utility>

#include "planner/any_angle/any_angle_planner.hpp"
#include "tests/perception/random_voxels.hpp"

namespace swiftlet {
namespace {

using test::random_free_voxel;
using test::random_voxels;

const Stop kNever = [] { return false; };

/// Lengths from `start` to every voxel by steps to free neighbours, past free ones: Dijkstra.
std::vector<double> lengths_from(const VoxelGrid& grid, Voxel start) {
  std::vector<double> lengths(grid.stored(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  lengths[grid.index(start)] = 0.0;
  open.push({0.0, grid.index(start)});
  while (!open.empty()) {
    const auto [length, index] = open.top();
    open.pop();
    if (length > lengths[index]) continue;
    const Voxel at = grid.voxel_at(index);
    for (int direction = 0; direction < 27; ++direction) {
      const Voxel by{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
      bool free = true;
      for (int part = 0; part < 8; ++part) {
        free = free && !grid.blocked(Voxel{at.x + (part & 1) * by.x, at.y + (part >> 1 & 1) * by.y,
                                           at.z + (part >> 2) * by.z});
      }
      if (!free) continue;
      const std::size_t next = grid.index({at.x + by.x, at.y + by.y, at.z + by.z});
      const double through = length + std::sqrt(by.x * by.x + by.y * by.y + by.z * by.z);
      if (through >= lengths[next] - 1e-12) continue;
      lengths[next] = through;
      open.push({through, next});
    }
  }
  return lengths;
}

SpaceLine middles(const std::vector<Voxel>& path) {
  SpaceLine line;
  for (const Voxel voxel : path) line.push_back(center_of(voxel));
  return line;
}

/// Maps of the plane and of space by turns, from open ones to such that fall apart.
VoxelGrid random_map(std::mt19937& random, int trial) {
  const double share = std::uniform_real_distribution<>(0.02, 0.5)(random);
  return random_voxels(random, trial % 2 == 0 ? Voxel{24, 18, 1} : Voxel{10, 9, 8}, share);
}

TEST(VoxelSearch, StepsAreAsShortAsDijkstraSays) {
  std::mt19937 random(1);
  int found = 0, cut_off = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const VoxelGrid grid = random_map(random, trial);
    const Voxel start = random_free_voxel(random, grid);
    const std::vector<double> lengths = lengths_from(grid, start);
    VoxelSearch search(grid);  // keeps its memory from goal to goal
    for (int i = 0; i < 5; ++i) {
      const Voxel goal = random_free_voxel(random, grid);
      const double expected = lengths[grid.index(goal)];
      for (const double weight : {1.0, 1.5}) {
        const auto result = search.run(start, goal, VoxelSearch::Moves::kSteps, weight, kNever);
        if (std::isinf(expected)) {
          ASSERT_EQ(result.end, VoxelSearch::End::kNoPath);
          ++cut_off;
          continue;
        }
        ASSERT_EQ(result.end, VoxelSearch::End::kFound);
        ASSERT_EQ(result.path.front(), start);
        ASSERT_EQ(result.path.back(), goal);
        const SpaceLine line = middles(result.path);
        ASSERT_TRUE(line_is_free(grid, line));
        ASSERT_GE(length_of(line), expected - 1e-4);
        ASSERT_LE(length_of(line), weight * expected + 1e-4);
        ++found;
      }
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(cut_off, 100);
}

TEST(VoxelSearch, SightFindsAPathExactlyWhereStepsDo) {
  std::mt19937 random(2);
  double steps = 0.0, sight = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const VoxelGrid grid = random_map(random, trial);
    const Voxel start = random_free_voxel(random, grid), goal = random_free_voxel(random, grid);
    VoxelSearch search(grid);
    const auto by_steps = search.run(start, goal, VoxelSearch::Moves::kSteps, 1.0, kNever);
    const auto by_sight = search.run(start, goal, VoxelSearch::Moves::kSight, 1.0, kNever);
    ASSERT_EQ(by_steps.end, by_sight.end);
    ASSERT_TRUE(line_is_free(grid, middles(by_sight.path)));
    steps += length_of(middles(by_steps.path));
    sight += length_of(middles(by_sight.path));
  }
  EXPECT_LT(sight, 0.97 * steps);
}

/// The shortest way in the plane from corner to corner of what is blocked, each a hair off it.
double shortest_in_plane(const VoxelGrid& grid, Voxel start, Voxel goal) {
  constexpr double kHair = 1e-6;
  SpaceLine nodes{center_of(start), center_of(goal)};
  for (int y = 0; y <= grid.size_y(); ++y) {
    for (int x = 0; x <= grid.size_x(); ++x) {
      for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const Eigen::Vector3d node(x + (quadrant % 2 == 0 ? kHair : -kHair),
                                   y + (quadrant / 2 == 0 ? kHair : -kHair), 0.5);
        if (line_is_free(grid, node, node)) nodes.push_back(node);
      }
    }
  }
  std::vector<double> lengths(nodes.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> done(nodes.size(), false);
  lengths[0] = 0.0;
  for (;;) {
    std::size_t best = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!done[i] && std::isfinite(lengths[i]) &&
          (best == nodes.size() || lengths[i] < lengths[best])) {
        best = i;
      }
    }
    if (best == nodes.size() || best == 1) return lengths[1];
    done[best] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double through = lengths[best] + (nodes[i] - nodes[best]).norm();
      if (through < lengths[i] && line_is_free(grid, nodes[best], nodes[i])) lengths[i] = through;
    }
  }
}

TEST(AnyAnglePlanner, InThePlaneIsWithinAFewThousandthsOfTheShortestWay) {
  std::mt19937 random(3);
  double sum = 0.0, worst = 0.0;
  int solved = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double share = std::uniform_real_distribution<>(0.05, 0.35)(random);
    const VoxelGrid grid = random_voxels(random, {20, 16, 1}, share);
    const Voxel start = random_free_voxel(random, grid), goal = random_free_voxel(random, grid);
    AnyAnglePlanner planner(grid);
    const AnyAnglePlanner::Plan plan = planner.plan(start, goal, kNever);
    const double shortest = shortest_in_plane(grid, start, goal);
    ASSERT_EQ(plan.line.empty(), std::isinf(shortest));
    if (plan.line.empty() || shortest == 0.0) continue;
    ASSERT_TRUE(line_is_free(grid, plan.line));
    ASSERT_GE(plan.length, shortest - 1e-3);
    sum += plan.length / shortest;
    worst = std::max(worst, plan.length / shortest);
    ++solved;
  }
  ASSERT_GT(solved, 40);
  EXPECT_LT(sum / solved, 1.005);
  EXPECT_LT(worst, 1.06);
}

TEST(AnyAnglePlanner, EachPathIsShorterThanTheLastAndStartsAndEndsWhereAsked) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 300; ++trial) {
    const VoxelGrid grid = random_map(random, trial);
    const Voxel start = random_free_voxel(random, grid), goal = random_free_voxel(random, grid);
    AnyAnglePlanner planner(grid);
    double last = std::numeric_limits<double>::infinity();
    const auto plan = planner.plan(start, goal, kNever, [&](const AnyAnglePlanner::Plan& found) {
      EXPECT_LT(found.length, last);
      last = found.length;
      EXPECT_TRUE(line_is_free(grid, found.line));
      EXPECT_EQ(found.line.front(), center_of(start));
      EXPECT_EQ(found.line.back(), center_of(goal));
    });
    if (plan.end == AnyAnglePlanner::End::kNoPath) continue;
    EXPECT_EQ(plan.end, AnyAnglePlanner::End::kDone);
    EXPECT_EQ(plan.length, last);
    EXPECT_DOUBLE_EQ(plan.length, length_of(plan.line));
  }
}

TEST(AnyAnglePlanner, StoppedKeepsWhatItHas) {
  std::mt19937 random(5);
  const VoxelGrid grid = random_voxels(random, {60, 60, 20}, 0.2);
  AnyAnglePlanner planner(grid);
  const Voxel start = random_free_voxel(random, grid), goal = random_free_voxel(random, grid);
  const auto whole = planner.plan(start, goal, kNever);
  ASSERT_EQ(whole.end, AnyAnglePlanner::End::kDone);

  bool has_first = false;
  const auto stopped = planner.plan(
      start, goal, [&] { return has_first; }, [&](const auto&) { has_first = true; });
  EXPECT_EQ(stopped.end, AnyAnglePlanner::End::kStopped);
  ASSERT_FALSE(stopped.line.empty());
  EXPECT_TRUE(line_is_free(grid, stopped.line));
  EXPECT_GT(stopped.length, whole.length);

  // The same afterwards as before.
  EXPECT_EQ(planner.plan(start, goal, kNever).line, whole.line);
}

TEST(AnyAnglePlanner, SaysWhyThereIsNone) {
  VoxelGrid grid = VoxelGrid::make(5, 5, 5).value();
  for (int z = 0; z < 5; ++z) {
    for (int y = 0; y < 5; ++y) grid.set_blocked({2, y, z});
  }
  AnyAnglePlanner planner(grid);
  EXPECT_EQ(planner.plan({0, 0, 0}, {4, 4, 4}, kNever).end, AnyAnglePlanner::End::kNoPath);
  EXPECT_EQ(planner.plan({2, 0, 0}, {4, 4, 4}, kNever).end, AnyAnglePlanner::End::kStartBlocked);
  EXPECT_EQ(planner.plan({0, 0, 0}, {2, 4, 4}, kNever).end, AnyAnglePlanner::End::kGoalBlocked);
  EXPECT_EQ(planner.plan({0, 0, 0}, {5, 4, 4}, kNever).end, AnyAnglePlanner::End::kGoalBlocked);
  const auto there = planner.plan({0, 0, 0}, {0, 0, 0}, kNever);
  EXPECT_EQ(there.end, AnyAnglePlanner::End::kDone);
  EXPECT_EQ(there.length, 0.0);
}

TEST(PullTaut, NeverTouchesAndNeverGetsLonger) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 300; ++trial) {
    const VoxelGrid grid = random_map(random, trial);
    const Voxel start = random_free_voxel(random, grid), goal = random_free_voxel(random, grid);
    VoxelSearch search(grid);
    const SpaceLine line =
        middles(search.run(start, goal, VoxelSearch::Moves::kSteps, 1.0, kNever).path);
    const SpaceLine taut = pull_taut(grid, line, kNever);
    EXPECT_TRUE(line_is_free(grid, taut));
    EXPECT_LE(length_of(taut), length_of(line) + 1e-12);
  }
}

TEST(PullTaut, OneTurnBecomesTwoWhereAWallHasTwoCorners) {
  VoxelGrid grid = VoxelGrid::make(10, 10, 1).value();
  for (int x = 0; x < 5; ++x) grid.set_blocked({x, 5, 0});
  const SpaceLine line{{0.5, 2.5, 0.5}, {8.5, 2.5, 0.5}, {8.5, 8.5, 0.5}, {0.5, 8.5, 0.5}};
  const SpaceLine taut = pull_taut(grid, line, kNever, 1e-4);
  const double shortest = std::hypot(4.5, 2.5) + 1.0 + std::hypot(4.5, 2.5);
  EXPECT_GE(length_of(taut), shortest);
  EXPECT_LE(length_of(taut), 1.005 * shortest);
}

}  // namespace
}  // namespace swiftlet
