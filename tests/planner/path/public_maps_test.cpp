// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps and optimal lengths of MovingAI (Sturtevant, Benchmarks for Grid-Based Pathfinding, 2012).
// Skipped without the data.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "planner/path/path_planner.hpp"
#include "tests/data_folder.hpp"
#include "tests/gzip_file.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

class MovingAi : public testing::TestWithParam<const char*> {};

TEST_P(MovingAi, PathsAreAsShortAsThePublishedOptimum) {
  const fs::path file = data_folder() / "planning2d" / "movingai" / GetParam();
  if (!fs::exists(file.string() + ".map.gz")) {
    GTEST_SKIP() << "no " << file << ".map.gz; set SWIFTLET_DATA to the data folder";
  }
  std::istringstream map(read_gzip(file.string() + ".map.gz"));
  std::string word, row;
  int width = 0, height = 0;
  map >> word >> word >> word >> height >> word >> width >> word;
  ASSERT_GT(width * height, 0);
  // Cells of 1 m, a vehicle without size between their centres: what the optimum is defined for,
  // but that it may turn at corners of cells only and in eight directions.
  OccupancyGrid::Params grid_params;
  grid_params.resolution = 1.0;
  OccupancyGrid grid(grid_params, {0, 0}, width, height);
  for (int y = 0; y < height; ++y) {
    map >> row;
    ASSERT_EQ(row.size(), static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x) {
      const char c = row[static_cast<std::size_t>(x)];
      grid.set_state({x, y}, c == '.' || c == 'G' ? CellState::kFree : CellState::kOccupied);
    }
  }
  PathPlanner::Params params;
  params.cost.radius = 0.45;  // all free cells are free, all diagonal gaps are closed
  params.cost.margin = 0.0;
  params.cost.clearance_weight = 0.0;
  params.cost.unknown_is_free = false;
  params.border = 0.0;
  const PathPlanner planner(params);
  const auto field = planner.make_map(grid, {0.5, 0.5});
  ASSERT_TRUE(field.ok());

  std::istringstream scenarios(read_gzip(file.string() + ".map.scen.gz"));
  std::getline(scenarios, row);
  int bucket = 0, w = 0, h = 0, x0 = 0, y0 = 0, x1 = 0, y1 = 0, planned = 0, line = 0;
  double optimum = 0.0, sum = 0.0;
  while (scenarios >> bucket >> word >> w >> h >> x0 >> y0 >> x1 >> y1 >> optimum) {
    if (++line % 40 != 0) continue;
    const PathResult result =
        planner.plan(*field, grid.center_of({x0, y0}), grid.center_of({x1, y1}),
                     static_cast<std::uint32_t>(line));
    ASSERT_TRUE(result.ok()) << line << ": " << result.reason;
    // Any angle, nearer past corners: shorter than in eight directions by 8 % and a bit, at most.
    EXPECT_GE(result.path.length, 0.85 * optimum) << line;
    EXPECT_LE(result.path.length, 1.10 * optimum + 1e-6) << line;
    sum += result.path.length / optimum;
    ++planned;
  }
  ASSERT_GT(planned, 3);
  EXPECT_LT(sum / planned, 1.01);
}

INSTANTIATE_TEST_SUITE_P(Maps, MovingAi, testing::Values("arena", "den312d", "Berlin_0_256"),
                         [](const auto& map) { return std::string(map.param); });

}  // namespace
}  // namespace swiftlet
