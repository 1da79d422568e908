// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/map_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace swiftlet {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class MapIo : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("swiftlet_map_io_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  std::string refusal(const std::string& yaml = "map.yaml") const {
    const auto map = load_map(folder_ / yaml);
    return map.ok() ? "it was loaded" : map.error().reason;
  }

  const std::string head_ =
      "image: map.pgm\nresolution: 0.05\norigin: [-1, 2.5, 0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  fs::path folder_;
};

OccupancyGrid sample_grid() {
  OccupancyGrid grid({}, {-1.25, 3.5}, 37, 23);
  std::mt19937 random(4);
  for (int y = 0; y < 23; ++y) {
    for (int x = 0; x < 37; ++x) grid.set_state({x, y}, static_cast<CellState>(random() % 3));
  }
  return grid;
}

TEST_F(MapIo, WritesWhatTheMapServerWrites) {
  OccupancyGrid grid({}, {-1.0, 2.5}, 3, 2);
  grid.set_state({0, 0}, CellState::kOccupied);  // lower left
  grid.set_state({2, 1}, CellState::kFree);      // upper right
  ASSERT_TRUE(save_map(grid, folder_ / "map.pgm").ok());
  // The top row comes first.
  EXPECT_EQ(read(folder_ / "map.pgm"),
            std::string("P5\n3 2\n255\n") + "\xCD\xCD\xFE" + std::string("\0\xCD\xCD", 3));
  EXPECT_EQ(read(folder_ / "map.yaml"),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1, 2.5, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST_F(MapIo, ARoundTripIsByteExact) {
  const OccupancyGrid grid = sample_grid();
  ASSERT_TRUE(save_map(grid, folder_ / "a.pgm").ok());
  const auto loaded = load_map(folder_ / "a.yaml");
  ASSERT_TRUE(loaded.ok()) << loaded.error().reason;
  ASSERT_EQ(loaded->width(), grid.width());
  ASSERT_EQ(loaded->height(), grid.height());
  EXPECT_EQ(loaded->origin(), grid.origin());
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) ASSERT_EQ(loaded->state({x, y}), grid.state({x, y}));
  }
  fs::create_directories(folder_ / "b");
  ASSERT_TRUE(save_map(*loaded, folder_ / "b" / "a.pgm").ok());
  EXPECT_EQ(read(folder_ / "a.pgm"), read(folder_ / "b" / "a.pgm"));
  EXPECT_EQ(read(folder_ / "a.yaml"), read(folder_ / "b" / "a.yaml"));
}

TEST_F(MapIo, ThePngHoldsTheSamePixels) {
  const OccupancyGrid grid = sample_grid();
  ASSERT_TRUE(save_map(grid, folder_ / "map.png").ok());
  EXPECT_FALSE(fs::exists(folder_ / "map.yaml"));
  write("map.yaml", "image: map.png\n" + head_.substr(head_.find('\n') + 1));
  const auto loaded = load_map(folder_ / "map.yaml");
  ASSERT_TRUE(loaded.ok()) << loaded.error().reason;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) ASSERT_EQ(loaded->state({x, y}), grid.state({x, y}));
  }
}

TEST_F(MapIo, ReadsPlainPgmWithCommentsSixteenBitsAndNegate) {
  write("map.yaml", head_);
  write("map.pgm", "P2 # plain\n# a comment\n2 # columns\n2\n255\n0 254\n205 255\n");
  auto map = load_map(folder_ / "map.yaml");
  ASSERT_TRUE(map.ok()) << map.error().reason;
  EXPECT_EQ(map->state({0, 1}), CellState::kOccupied);
  EXPECT_EQ(map->state({1, 1}), CellState::kFree);
  EXPECT_EQ(map->state({0, 0}), CellState::kUnknown);
  EXPECT_EQ(map->state({1, 0}), CellState::kFree);
  EXPECT_EQ(map->origin(), Eigen::Vector2d(-1.0, 2.5));

  write("map.pgm", std::string("P5 2 1 65535\n") + std::string("\x00\x01\xFF\xF0", 4));
  map = load_map(folder_ / "map.yaml");
  ASSERT_TRUE(map.ok()) << map.error().reason;
  EXPECT_EQ(map->state({0, 0}), CellState::kOccupied);
  EXPECT_EQ(map->state({1, 0}), CellState::kFree);

  std::string negated = head_;
  negated.replace(negated.find("negate: 0"), 9, "negate: 1");
  write("map.yaml", negated);
  map = load_map(folder_ / "map.yaml");
  ASSERT_TRUE(map.ok()) << map.error().reason;
  EXPECT_EQ(map->state({0, 0}), CellState::kFree);
  EXPECT_EQ(map->state({1, 0}), CellState::kOccupied);
}

TEST_F(MapIo, ScaleModeKeepsTheProbabilityInBetween) {
  write("map.yaml", head_ + "mode: scale\n");
  write("map.pgm", "P2 3 1 100\n60 0 100\n");
  const auto map = load_map(folder_ / "map.yaml");
  ASSERT_TRUE(map.ok()) << map.error().reason;
  EXPECT_NEAR(map->probability({0, 0}), 0.4, 1e-3);
  EXPECT_EQ(map->state({1, 0}), CellState::kOccupied);
  EXPECT_EQ(map->state({2, 0}), CellState::kFree);
}

TEST_F(MapIo, EveryRefusalNamesTheFileAndTheProblem) {
  EXPECT_THAT(refusal("absent.yaml"), AllOf(HasSubstr("absent.yaml"), HasSubstr("opened")));
  write("map.yaml", head_);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("map.pgm"), HasSubstr("opened")));
  const std::pair<std::string, std::string> images[] = {
      {"", "short"},
      {"P5 3", "height"},
      {"P5 2 2 255\nab", "ends early"},
      {"P5 0 2 255\nab", "0 x 2"},
      {"P5 99999999 99999999 255\n", "claims"},
      {"P5 2 1 70000\nab", "white"},
      {"P2 2 1 9\n1 10\n", "above its white"},
      {"P2 2 2 9\n1 2 3 x\n", "pixels"},
      {"not an image at all", "not an image"},
  };
  for (const auto& [content, problem] : images) {
    write("map.pgm", content);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("map.pgm"), HasSubstr(problem))) << content;
  }
  write("map.pgm", "P2 1 1 255 0\n");
  ASSERT_EQ(refusal(), "it was loaded");
  const std::pair<std::string, std::string> edits[][2] = {
      {{"resolution: 0.05", "resolution: -1"}, {"resolution", ""}},
      {{"resolution: 0.05", "resolution: .nan"}, {"resolution", ""}},
      {{"resolution: 0.05\n", ""}, {"resolution", ""}},
      {{"origin: [-1, 2.5, 0]", "origin: [-1]"}, {"origin", ""}},
      {{"origin: [-1, 2.5, 0]", "origin: [-1, 2.5, 0.3]"}, {"turns", ""}},
      {{"origin: [-1, 2.5, 0]", "origin: [-1, east, 0]"}, {"origin", ""}},
      {{"negate: 0", "negate: maybe"}, {"negate", ""}},
      {{"free_thresh: 0.196", "free_thresh: 0.9"}, {"free_thresh", ""}},
      {{"image: map.pgm", "imago: map.pgm"}, {"image", ""}},
      {{"negate: 0", "mode: raw"}, {"raw", ""}},
      {{"image: map.pgm", "image: [unclosed"}, {"YAML", ""}},
  };
  for (const auto& edit : edits) {
    std::string yaml = head_;
    yaml.replace(yaml.find(edit[0].first), edit[0].first.size(), edit[0].second);
    write("map.yaml", yaml);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("map.yaml"), HasSubstr(edit[1].first))) << yaml;
  }
  write("map.yaml", "just words");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("map.yaml"), HasSubstr("mapping")));
}

TEST_F(MapIo, EveryCutOfAFileIsRefusedOrWhole) {
  ASSERT_TRUE(save_map(sample_grid(), folder_ / "map.pgm").ok());
  const std::string whole = read(folder_ / "map.pgm");
  for (std::size_t length = 0; length < whole.size(); length += 11) {
    write("map.pgm", whole.substr(0, length));
    ASSERT_FALSE(load_map(folder_ / "map.yaml").ok()) << length;
  }
}

TEST_F(MapIo, RefusesToWriteWhatItCannotAndLeavesNothingBehind) {
  EXPECT_FALSE(save_map(OccupancyGrid(), folder_ / "map.pgm").ok());
  EXPECT_FALSE(save_map(sample_grid(), folder_ / "map.jpg").ok());
  const Status status = save_map(sample_grid(), folder_ / "absent" / "map.pgm");
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().reason, HasSubstr("absent"));
  // A folder is in the way of the name.
  fs::create_directories(folder_ / "taken.pgm" / "inside");
  EXPECT_FALSE(save_map(sample_grid(), folder_ / "taken.pgm").ok());
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename(), "taken.pgm");
  }
}

}  // namespace
}  // namespace swiftlet
