// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/fast_marching_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

class FastMarchingTree : public testing::Test {
 protected:
  Polyline plan(std::uint32_t seed, int samples = 200) const {
    FastMarchingTreeParams params;
    params.samples = samples;
    return fast_marching_tree(map_, fill_, start_, goal_, params, seed);
  }

  const Eigen::Vector2d start_{1, 1}, goal_{3, 9};
  const ClearanceMap map_ = *ClearanceMap::make(test::office(), {});
  const FloodFill fill_ = flood_fill(map_, map_.cell_of(start_), map_.cell_of(goal_));
};

TEST_F(FastMarchingTree, ConnectsThroughBothDoorways) {
  int connected = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Polyline line = plan(seed);
    if (line.empty()) continue;
    ++connected;
    EXPECT_EQ(line.front(), start_);
    EXPECT_EQ(line.back(), goal_);
    EXPECT_TRUE(std::isfinite(polyline_cost(map_, line)));
  }
  EXPECT_GE(connected, 34);
}

TEST_F(FastMarchingTree, CostsHardlyMoreThanTheCheapestWayOverCells) {
  Polyline cells{start_};
  for (const Cell cell : fill_.to_goal) cells.push_back(map_.center_of(cell));
  cells.push_back(goal_);
  const double least = 0.924 * polyline_cost(map_, cells);  // any angle for eight directions
  double sum = 0.0;
  int connected = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Polyline line = plan(seed);
    if (line.empty()) continue;
    const double cost = polyline_cost(map_, line);
    EXPECT_GT(cost, least);
    sum += cost;
    ++connected;
  }
  ASSERT_GT(connected, 0);
  EXPECT_LT(sum / connected, 1.1 * least / 0.924);
}

TEST_F(FastMarchingTree, DependsOnItsSeedAndOnNothingElse) {
  const Polyline first = plan(7);
  ASSERT_FALSE(first.empty());
  EXPECT_NE(plan(8), first);
  EXPECT_EQ(plan(7), first);
  std::vector<Polyline> lines(4);
  std::vector<std::thread> threads;
  for (Polyline& line : lines) threads.emplace_back([&] { line = plan(7); });
  for (std::thread& thread : threads) thread.join();
  for (const Polyline& line : lines) EXPECT_EQ(line, first);
}

TEST_F(FastMarchingTree, SaysNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  (void)plan(1);
  (void)plan(1, 3);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace swiftlet
