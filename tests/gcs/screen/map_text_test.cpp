// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <sstream>

#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/map_scene.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

const Time kNow(1000s);

/// A closed room of `width` x `height` metres from the origin on, in the middle of what is unknown.
std::shared_ptr<const GridMap> room(double width, double height) {
  constexpr double kCell = 0.1;
  constexpr int kAround = 30;
  auto map = std::make_shared<GridMap>();
  const int columns = static_cast<int>(width / kCell), rows = static_cast<int>(height / kCell);
  map->width = columns + 2 * kAround;
  map->height = rows + 2 * kAround;
  map->resolution = kCell;
  map->origin = {-kAround * kCell, -kAround * kCell};
  map->cells.assign(static_cast<std::size_t>(map->width * map->height), -1);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const bool wall = x == 0 || y == 0 || x == columns - 1 || y == rows - 1;
      map->cells[static_cast<std::size_t>((y + kAround) * map->width + x + kAround)] =
          wall ? 100 : 0;
    }
  }
  return map;
}

VehicleReport flying(const std::string& mode, bool navigates) {
  VehicleReport report;
  report.mode = mode;
  report.in_flight = true;
  report.navigates = navigates;
  report.takeoff_point = {1.0, 1.0, 0.0};
  return report;
}

std::vector<std::u32string> lines_of(const std::string& text) {
  std::vector<std::u32string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(decode(line));
  return lines;
}

/// Column and row of the only glyph of that kind.
std::pair<int, int> place_of(const std::vector<std::u32string>& lines, char32_t glyph) {
  std::pair<int, int> place{-1, -1};
  for (std::size_t y = 0; y < lines.size(); ++y) {
    for (std::size_t x = 0; x < lines[y].size(); ++x) {
      if (lines[y][x] != glyph) continue;
      EXPECT_EQ(place.first, -1) << "more than one";
      place = {static_cast<int>(x), static_cast<int>(y)};
    }
  }
  return place;
}

TEST(MapText, ShowsAllThatIsKnownAsWideAsAskedForAndInProportion) {
  for (const int width : {20, 40, 80, 200}) {
    GroundStationModel model;
    model.hear_map(room(12.0, 6.0), kNow);
    const auto lines = lines_of(map_text(model, kNow, width, false));
    // A row is as high as two columns are wide.
    EXPECT_NEAR(static_cast<double>(lines.size()), width / 4.0, 3.0) << width;
    std::size_t longest = 0;
    for (const auto& line : lines) longest = std::max(longest, line.size());
    EXPECT_LE(longest, static_cast<std::size_t>(width));
    EXPECT_GE(longest, static_cast<std::size_t>(width) - 4);
  }
}

TEST(MapText, ATallMapIsNoHigherThanHalfItsWidthAndWhole) {
  GroundStationModel model;
  model.hear_map(room(3.0, 60.0), kNow);
  RigidBodyState state;
  state.p_WB = {1.5, 59.0, 1.0};
  model.hear(state, kNow);
  const auto lines = lines_of(map_text(model, kNow, 80, false));
  EXPECT_EQ(lines.size(), 40u);
  const auto [column, row] = place_of(lines, U'→');
  EXPECT_NEAR(column, 40, 3) << "in the middle";
  EXPECT_LE(row, 3) << "at the far end";
}

TEST(MapText, VehiclePadAndPathAreWhereTheyAre) {
  GroundStationModel model;
  model.hear_map(room(12.0, 6.0), kNow);
  model.hear(flying("Indoor Navigation", true), kNow);
  RigidBodyState state;
  state.p_WB = {11.0, 5.0, 1.0};
  state.q_WB = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  model.hear(state, kNow);
  const std::string without_path = map_text(model, kNow, 80, false);
  const auto lines = lines_of(without_path);
  EXPECT_THAT(without_path, HasSubstr("↑ N"));
  const auto [pad_column, pad_row] = place_of(lines, U'H');
  int arrows = 0;
  for (const auto& line : lines)
    arrows += static_cast<int>(std::count(line.begin(), line.end(), U'↑'));
  EXPECT_EQ(arrows, 2) << "the vehicle looks north, and so does the map";
  const double columns_per_metre = 78.0 / 12.0;
  EXPECT_NEAR(pad_column, 1.0 + 1.0 * columns_per_metre, 1.5);
  EXPECT_GT(pad_row, static_cast<int>(lines.size()) / 2) << "south is below";
  model.hear_path({{1.0, 1.0}, {11.0, 5.0}}, kNow);
  EXPECT_NE(map_text(model, kNow, 80, false), without_path);
  model.hear(flying("Hover", false), kNow);
  EXPECT_EQ(map_text(model, kNow, 80, false), without_path) << "an old path is none";
}

TEST(MapText, AVehicleOutsideOfTheMapIsShownWithIt) {
  GroundStationModel model;
  model.hear_map(room(4.0, 4.0), kNow);
  RigidBodyState state;
  state.p_WB = {14.0, 2.0, 1.0};
  model.hear(state, kNow);
  const auto lines = lines_of(map_text(model, kNow, 60, false));
  EXPECT_GE(place_of(lines, U'→').first, 55);
}

TEST(MapText, InAsciiThereIsNothingElse) {
  GroundStationModel model;
  model.hear_map(room(12.0, 6.0), kNow);
  for (const char c : map_text(model, kNow, 80, true)) {
    ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F)) << static_cast<int>(c);
  }
  EXPECT_THAT(map_text(model, kNow, 80, true), HasSubstr("+::::")) << "a wall";
}

TEST(MapText, IsEmptyWhereNothingIsKnown) {
  GroundStationModel model;
  EXPECT_EQ(map_text(model, kNow, 80, false), "");
  auto unknown = std::make_shared<GridMap>(*room(4.0, 4.0));
  unknown->cells.assign(unknown->cells.size(), -1);
  model.hear_map(unknown, kNow);
  EXPECT_EQ(map_text(model, kNow, 80, false), "");
}

TEST(Printable, HasNoControlCharacters) {
  EXPECT_EQ(printable("a\x1b[31mb → c\n", false), "a\xEF\xBF\xBD[31mb → c\xEF\xBF\xBD");
  EXPECT_EQ(printable("a → b ×2\x07", true), "a > b x2?");
}

}  // namespace
}  // namespace swiftlet::screen
