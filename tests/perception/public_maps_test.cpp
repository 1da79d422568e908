// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps of Nav2, as people have them. Skipped without the data.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "perception/distance_field.hpp"
#include "perception/map_io.hpp"
#include "tests/data_folder.hpp"
#include "tests/gzip_file.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

struct PublicMap {
  std::string name;    // of the file, without nav2_
  int width, height;   // of the image
  double free_m2_min;  // floor that a person can see in it
};

class PublicMaps : public testing::TestWithParam<PublicMap> {};

TEST_P(PublicMaps, LoadsAndKeepsItsWallsAndFloor) {
  const PublicMap& expected = GetParam();
  const fs::path source = data_folder() / "planning2d" / "ros_maps";
  if (!fs::exists(source / ("nav2_" + expected.name + ".yaml"))) {
    GTEST_SKIP() << "no public maps in " << source << "; set SWIFTLET_DATA to the data folder";
  }
  const fs::path folder = fs::path(testing::TempDir()) / ("swiftlet_public_map_" + expected.name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  fs::copy(source / ("nav2_" + expected.name + ".yaml"), folder / "map.yaml");
  std::ofstream(folder / (expected.name + ".pgm"), std::ios::binary)
      << read_gzip(source / ("nav2_" + expected.name + ".pgm.gz"));
  const auto map = load_map(folder / "map.yaml");
  ASSERT_TRUE(map.ok()) << map.error().reason;
  EXPECT_EQ(map->width(), expected.width);
  EXPECT_EQ(map->height(), expected.height);
  int free = 0, occupied = 0;
  for (int y = 0; y < map->height(); ++y) {
    for (int x = 0; x < map->width(); ++x) {
      free += map->state({x, y}) == CellState::kFree;
      occupied += map->state({x, y}) == CellState::kOccupied;
    }
  }
  EXPECT_GT(free * map->resolution() * map->resolution(), expected.free_m2_min);
  EXPECT_GT(occupied, 500);
  EXPECT_LT(occupied, free);
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Nav2, PublicMaps,
                         testing::Values(PublicMap{"depot", 604, 307, 200.0},
                                         PublicMap{"tb3_sandbox", 384, 384, 15.0},
                                         PublicMap{"warehouse", 1006, 1674, 500.0}),
                         [](const auto& map) { return map.param.name; });

}  // namespace
}  // namespace swiftlet
