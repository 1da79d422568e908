// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A point that scans and walks through random houses, where the explorer says.
#include "planner/exploration/explorer.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <optional>

#include "tests/planner/exploration/exploration_walk.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet {
namespace {

using Kind = ExplorationStep::Kind;
using test::ExplorationWalk;
using test::RandomHouse;

const double kClearance = Explorer::Params().clearance;

TEST(Explorer, SeesAllOfRandomHousesAndComesHome) {
  const unsigned houses = test::kSlowdown > 1 ? 1 : 5;
  for (unsigned seed = 1; seed <= houses; ++seed) {
    SCOPED_TRACE(seed);
    RandomHouse house(seed);
    const Eigen::Vector2d start = house.free_place(0.6);
    Explorer explorer;
    ExplorationWalk walk(house, start);
    ASSERT_TRUE(
        walk.run([&](const OccupancyGrid& grid,
                     const Eigen::Vector2d& position) { return explorer.step(grid, position); },
                 kClearance));
    EXPECT_GE(walk.mapped_share(house, start, kClearance), 0.99);
    EXPECT_LT(walk.length, 120.0) << "it turns back and forth";
  }
}

/// [m] through some houses, and back.
double length_through_houses(const Explorer::Params& params) {
  double length = 0.0;
  const unsigned houses = test::kSlowdown > 1 ? 1 : 4;
  for (unsigned seed = 1; seed <= houses; ++seed) {
    RandomHouse house(seed);
    const Eigen::Vector2d start = house.free_place(0.6);
    Explorer explorer(params);
    ExplorationWalk walk(house, start);
    const bool finished =
        walk.run([&](const OccupancyGrid& grid,
                     const Eigen::Vector2d& position) { return explorer.step(grid, position); },
                 kClearance);
    EXPECT_TRUE(finished) << "house " << seed;
    length += walk.length;
    std::printf("house %u: %.1f m\n", seed, walk.length);
  }
  return length;
}

TEST(Explorer, HasAShorterWayThanTheRuleOf1997) {
  Explorer::Params of_1997;
  of_1997.rule_of_1997 = true;
  const double ours = length_through_houses({});
  const double theirs = length_through_houses(of_1997);
  EXPECT_LT(ours, 0.95 * theirs);
}

TEST(Explorer, ToTheEndMeansToTheViewpoint) {
  RandomHouse house(3);
  const Eigen::Vector2d start = house.free_place(0.6);
  Explorer::Params params;
  params.rule_of_1997 = true;
  Explorer explorer(params);
  ExplorationWalk walk(house, start);
  std::optional<Eigen::Vector2d> last;
  int changes = 0;
  EXPECT_TRUE(walk.run(
      [&](const OccupancyGrid& grid, const Eigen::Vector2d& position) {
        ExplorationStep step = explorer.step(grid, position);
        if (last && (step.kind != Kind::kLook || step.viewpoint != *last)) {
          EXPECT_LE((position - *last).norm(), params.arrival_distance);
          ++changes;
        }
        last.reset();
        if (step.kind == Kind::kLook) last = step.viewpoint;
        return step;
      },
      kClearance));
  EXPECT_GT(changes, 3);
}

TEST(Explorer, AHouseThatIsKnownIsFinishedAtOnce) {
  RandomHouse house(3);
  const Eigen::Vector2d start = house.free_place(0.6);
  ExplorationWalk walk(house, start);
  Explorer first;
  ASSERT_TRUE(walk.run([&](const OccupancyGrid& grid,
                           const Eigen::Vector2d& position) { return first.step(grid, position); },
                       kClearance));
  Explorer second;
  EXPECT_EQ(second.step(walk.grid, start).kind, Kind::kFinished);
}

TEST(Explorer, TheSameMapsGiveTheSameSteps) {
  std::vector<Eigen::Vector2d> tracks[2];
  for (auto& track : tracks) {
    RandomHouse house(2);
    const Eigen::Vector2d start = house.free_place(0.6);
    Explorer explorer;
    ExplorationWalk walk(house, start);
    (void)walk.run([&](const OccupancyGrid& grid,
                       const Eigen::Vector2d& position) { return explorer.step(grid, position); },
                   kClearance);
    track = walk.track;
  }
  EXPECT_GT(tracks[0].size(), 100U);
  EXPECT_EQ(tracks[0], tracks[1]);
}

TEST(Explorer, WhatCannotBeReachedIsGivenUp) {
  RandomHouse house(4);
  const Eigen::Vector2d start = house.free_place(0.6);
  ExplorationWalk walk(house, start);
  Explorer explorer;
  walk.scan();
  // Nobody ever finds a way: every frontier is given up, twice at most.
  int steps = 0;
  while (explorer.step(walk.grid, start).kind == Kind::kLook) {
    explorer.give_up();
    ASSERT_LT(++steps, 200);
  }
  EXPECT_GT(steps, 2);
  explorer.reset();
  EXPECT_EQ(explorer.step(walk.grid, start).kind, Kind::kLook);
}

/// A room of 4 m that has been seen, with a doorway in the east, and in the west a piece of wall of
/// 45 cm that no ray has hit, too narrow to fly through. What lies around the room is unknown.
OccupancyGrid room_with_an_unseen_piece_of_wall() {
  constexpr int kMargin = 30, kRoom = 80, kSize = kRoom + 2 * kMargin;
  constexpr int kWest = kMargin, kEast = kMargin + kRoom - 1;
  OccupancyGrid grid({}, {0.0, 0.0}, kSize, kSize);
  const auto is_near_middle = [](int y, int cells) { return std::abs(y - kSize / 2) <= cells; };
  for (int y = kWest; y <= kEast; ++y) {
    for (int x = kWest; x <= kEast; ++x) {
      if (x == kWest && is_near_middle(y, 4)) continue;
      const bool doorway = x == kEast && is_near_middle(y, 10);
      const bool wall = x == kWest || x == kEast || y == kWest || y == kEast;
      grid.set_state({x, y}, wall && !doorway ? CellState::kOccupied : CellState::kFree);
    }
  }
  return grid;
}

TEST(Explorer, AnUnseenPieceOfWallIsNoFrontierBecauseAWayAroundTheHouseMightBeFree) {
  const OccupancyGrid grid = room_with_an_unseen_piece_of_wall();
  const Eigen::Vector2d middle =
      grid.origin() + 0.5 * grid.resolution() * Eigen::Vector2d(grid.width(), grid.height());
  const ExplorationStep ours = Explorer().step(grid, middle);
  ASSERT_EQ(ours.kind, Kind::kLook);
  EXPECT_EQ(ours.frontiers, 1U);
  EXPECT_GT(ours.viewpoint.x(), middle.x()) << "the doorway is in the east";
  Explorer::Params of_1997;
  of_1997.rule_of_1997 = true;
  EXPECT_EQ(Explorer(of_1997).step(grid, middle).frontiers, 2U);
}

TEST(Explorer, WithoutAMapOrAPlaceItIsStuckAndSaysWhy) {
  Explorer explorer;
  const ExplorationStep nowhere = explorer.step(OccupancyGrid(), {0.0, 0.0});
  EXPECT_EQ(nowhere.kind, Kind::kStuck);
  EXPECT_EQ(nowhere.reason, "there is no map yet");
  RandomHouse house(1);
  ExplorationWalk walk(house, house.free_place(0.6));
  walk.scan();
  EXPECT_EQ(explorer.step(walk.grid, {NAN, 0.0}).kind, Kind::kStuck);
  const ExplorationStep outside = explorer.step(walk.grid, {-40.0, 3.0});
  EXPECT_EQ(outside.kind, Kind::kStuck);
  EXPECT_EQ(outside.reason, "no known free place is large enough for the vehicle where it is");
}

}  // namespace
}  // namespace swiftlet
