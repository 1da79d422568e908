// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The public planning problems, the proof, and the peers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "components/experiments/planning/collision_peer.hpp"
#include "components/experiments/planning/map_files.hpp"
#include "components/experiments/planning/ompl_peers.hpp"
#include "components/experiments/planning/planning_benchmark.hpp"
#include "components/experiments/planning/proof.hpp"
#include "planner/any_angle/any_angle_planner.hpp"
#include "tests/perception/random_voxels.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// A folder of this test, gone with it. What is named .gz need not be compressed to be read.
class PlanningFiles : public testing::Test {
 protected:
  PlanningFiles()
      : folder_(fs::temp_directory_path() /
                ("swiftlet-planning-" + std::to_string(getpid()) + "-" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_ / "below");
  }
  ~PlanningFiles() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string error_of(const std::string& map, const std::string& problems, bool in_space) const {
    write("broken.map", map);
    write("broken.scen", problems);
    const auto read = read_planning_map(
        {"broken", folder_ / "broken.map", folder_ / "broken.scen", in_space}, 100);
    return read.ok() ? "" : read.error().reason;
  }

  const fs::path folder_;
};

constexpr const char* kPlane = "type octile\nheight 3\nwidth 4\nmap\n.G@.\nS.T.\nW..O\n";
constexpr const char* kPlaneProblems =
    "version 1\n0\tx.map\t4\t3\t0\t0\t1\t0\t1.0\n7 x.map 4 3 0 0 2 2 3.41421356\n";
constexpr const char* kSpace = "voxel 3 4 5\n0 0 0\n2 3 4\n";
constexpr const char* kSpaceProblems = "version 1\nx.3dmap\n1 0 0 2 0 0 1.0 1.0\n1 0 0 1 3 0 3 1\n";

TEST_F(PlanningFiles, AreFoundByTheirNamesInAnyDepth) {
  write("a.map.gz", kPlane);
  write("a.map.scen.gz", kPlaneProblems);
  write("below/b.3dmap.gz", kSpace);
  write("below/b.3dmap.3dscen.gz", kSpaceProblems);
  write("lonely.map.gz", kPlane);
  const auto files = find_planning_maps(folder_);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].name, "a");
  EXPECT_FALSE(files[0].in_space);
  EXPECT_EQ(files[1].name, "b");
  EXPECT_TRUE(files[1].in_space);

  const auto plane = read_planning_map(files[0], 1);
  ASSERT_TRUE(plane.ok()) << plane.error().reason;
  EXPECT_EQ(plane->grid.size_x(), 4);
  EXPECT_EQ(plane->grid.size_y(), 3);
  EXPECT_TRUE(plane->grid.blocked(Voxel{2, 0, 0}));
  EXPECT_FALSE(plane->grid.blocked(Voxel{1, 0, 0}));
  EXPECT_TRUE(plane->grid.blocked(Voxel{2, 1, 0}));
  EXPECT_TRUE(plane->grid.blocked(Voxel{0, 2, 0}));
  ASSERT_EQ(plane->problems.size(), 1u);  // the last
  EXPECT_EQ(plane->problems[0].goal, (Voxel{2, 2, 0}));
  EXPECT_DOUBLE_EQ(plane->problems[0].octile_length, 3.41421356);

  const auto space = read_planning_map(files[1], 100);
  ASSERT_TRUE(space.ok()) << space.error().reason;
  EXPECT_TRUE(space->grid.blocked(Voxel{2, 3, 4}));
  EXPECT_FALSE(space->grid.blocked(Voxel{1, 1, 1}));
  EXPECT_EQ(space->problems.size(), 2u);
}

TEST_F(PlanningFiles, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_THAT(error_of("type octile\nheight 3\nwidth 4\n", kPlaneProblems, false),
              HasSubstr("no line 'map'"));
  EXPECT_THAT(error_of("type octile\nheight 2\nwidth 2\nmap\n..\n...\n", kPlaneProblems, false),
              AllOf(HasSubstr("broken.map:6"), HasSubstr("3 characters in a row of 2")));
  EXPECT_THAT(error_of("type octile\nheight 2\nwidth 2\nmap\n..\n", kPlaneProblems, false),
              HasSubstr("1 rows of 2"));
  EXPECT_THAT(error_of("type octile\nheight -2\nwidth 2\nmap\n..\n", kPlaneProblems, false),
              HasSubstr("no inside"));
  EXPECT_THAT(error_of(kPlane, "version 1\n0 x 4 3 0 0 2 0 2\n", false),
              AllOf(HasSubstr("broken.scen:2"), HasSubstr("blocked")));
  EXPECT_THAT(error_of(kPlane, "version 1\n0 x 4 3 0 0 9 0 2\n", false), HasSubstr("outside"));
  EXPECT_THAT(error_of(kPlane, "version 1\n", false), HasSubstr("no problem"));
  EXPECT_THAT(error_of(kPlane, std::string(kPlaneProblems) + "7 x.map 4 3\n", false),
              AllOf(HasSubstr("broken.scen:4"), HasSubstr("not a problem")));
  EXPECT_THAT(error_of("cube 3 4 5\n", kSpaceProblems, true), HasSubstr("'voxel X Y Z'"));
  EXPECT_THAT(error_of("voxel 3 4 5\n0 0\n", kSpaceProblems, true), HasSubstr("broken.map:2"));
  EXPECT_THAT(error_of("voxel 3 4 5\n0 0 7\n", kSpaceProblems, true), HasSubstr("outside"));
  EXPECT_THAT(error_of("", kSpaceProblems, true), HasSubstr("'voxel X Y Z'"));
}

TEST_F(PlanningFiles, AFolderWithoutMapsIsAnError) {
  ExperimentOptions options;
  options.data = folder_;
  const auto result = run_planning_benchmark(options);
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().reason, AllOf(HasSubstr(folder_.string()), HasSubstr(".scen.gz")));
}

TEST_F(PlanningFiles, TheExperimentSolvesEveryProblemAndSaysSo) {
  write("a.map.gz", kPlane);
  write("a.map.scen.gz", kPlaneProblems);
  write("b.3dmap.gz", kSpace);
  write("b.3dmap.3dscen.gz", kSpaceProblems);
  ExperimentOptions options;
  options.data = folder_;
  const auto result = run_planning_benchmark(options);
  ASSERT_TRUE(result.ok()) << result.error().reason;
  int solved = 0;
  for (const ExperimentRow& row : result->rows) {
    if (row.quantity != "a solved, with proof" && row.quantity != "b solved, with proof") continue;
    EXPECT_EQ(row.median(), 100.0);
    ++solved;
  }
  EXPECT_EQ(solved, 2);
}

TEST(Proof, AgreesWithTheCheckThatPlansAreMadeWith) {
  std::mt19937 random(1);
  int free = 0;
  constexpr int kTrials = 20'000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const VoxelGrid grid = test::random_voxels(random, {8, 7, 6}, 0.05);
    const auto point = [&random] {
      const auto along = [&random](double size) {
        return std::uniform_real_distribution<>(0.0, size)(random);
      };
      return Eigen::Vector3d(along(8.0), along(7.0), along(6.0));
    };
    const Eigen::Vector3d a = point(), b = point();
    ASSERT_EQ(proven_free(grid, {a, b}), line_is_free(grid, a, b));
    free += proven_free(grid, {a, b}) ? 1 : 0;
  }
  EXPECT_GT(free, kTrials / 10);
  EXPECT_LT(free, kTrials * 9 / 10);
}

TEST(Proof, AWayThroughACornerIsNone) {
  VoxelGrid grid = VoxelGrid::make(4, 4, 1).value();
  grid.set_blocked({1, 1, 0});
  EXPECT_FALSE(proven_free(grid, {{0.5, 2.5, 0.5}, {1.5, 3.5, 0.5}, {0.5, 0.5, 0.5}}));
  EXPECT_FALSE(proven_free(grid, {{1.5, 0.5, 0.5}, {2.5, 1.5, 0.5}}));  // touches its corner
  EXPECT_TRUE(proven_free(grid, {{1.5, 0.5, 0.5}, {2.5, 0.5, 0.5}, {2.5, 2.5, 0.5}}));
  EXPECT_FALSE(proven_free(grid, {}));
}

TEST(CollisionPeer, NothingIsFreeWhereFclSaysContact) {
  std::mt19937 random(2);
  int contacts = 0, checks = 0, needless = 0;
  for (const double share : {0.001, 0.01, 0.05}) {
    for (const double radius : {0.3, 1.0, 1.5, 2.7}) {
      const VoxelGrid grid = test::random_voxels(random, {40, 32, 24}, share);
      const CollisionComparison compared = compare_with_fcl(grid, radius, 3000, 3);
      EXPECT_EQ(compared.missed, 0) << share << ' ' << radius;
      contacts += compared.contacts;
      needless += compared.needless;
      checks += compared.checks;
    }
  }
  EXPECT_GT(contacts, checks / 10);
  EXPECT_LT(contacts, checks * 9 / 10);
  EXPECT_LT(needless, checks / 2);
}

TEST(OmplPeers, TheirPathsAreFreeTooSinceMotionsAreCheckedExactly) {
  std::mt19937 random(4);
  seed_ompl(1);
  int solved = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const VoxelGrid grid =
        test::random_voxels(random, trial % 2 == 0 ? Voxel{30, 30, 1} : Voxel{12, 12, 12}, 0.15);
    const Voxel start = test::random_free_voxel(random, grid),
                goal = test::random_free_voxel(random, grid);
    for (const OmplPeer peer : {OmplPeer::kRrtConnect, OmplPeer::kBitStar}) {
      const SpaceLine line = plan_with_ompl(peer, grid, start, goal, 0.05);
      if (line.empty()) continue;
      ++solved;
      EXPECT_TRUE(proven_free(grid, line));
      EXPECT_EQ(line.front(), center_of(start));
      EXPECT_EQ(line.back(), center_of(goal));
    }
  }
  EXPECT_GT(solved, 0);
}

}  // namespace
}  // namespace swiftlet
