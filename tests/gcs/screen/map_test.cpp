// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "gcs/screen/drawing/braille.hpp"
#include "gcs/screen/drawing/map_drawing.hpp"
#include "gcs/screen/state/map_camera.hpp"

namespace swiftlet::screen {
namespace {

constexpr double kResolution = 0.05;

/// Free cells, and walls of one cell along row 70 and column 30.
std::shared_ptr<GridMap> room() {
  auto map = std::make_shared<GridMap>();
  map->width = 100;
  map->height = 120;
  map->resolution = kResolution;
  map->origin = {-1.0, -2.0};
  map->cells.assign(100 * 120, 0);
  for (int x = 0; x < 100; ++x) map->cells[static_cast<std::size_t>(70 * 100 + x)] = 100;
  for (int y = 0; y < 120; ++y) map->cells[static_cast<std::size_t>(y * 100 + 30)] = 100;
  return map;
}

/// Whether the picture has a wall at a place of the world.
bool wall_at(const MapPicture& picture, const MapView& view, const Eigen::Vector2d& place) {
  const Eigen::Vector2d dot = to_dots(view, picture.width(), picture.height(), place);
  return picture.at(static_cast<int>(std::floor(dot.x())), static_cast<int>(std::floor(dot.y()))) ==
         MapPicture::Dot::kOccupied;
}

TEST(MapPicture, NoWallOfOneCellVanishesAtAnyZoom) {
  const auto map = room();
  const Eigen::Vector2d middle = map->origin + Eigen::Vector2d(2.5, 3.0);
  for (double metres_per_dot = 0.01; metres_per_dot < 2.0; metres_per_dot *= 1.13) {
    const MapView view{middle + Eigen::Vector2d(0.0123, -0.0071), metres_per_dot};
    MapPicture picture;
    picture.update(map, view, 160, 120);
    const double half = std::min(2.3, 0.9 * 60 * metres_per_dot);
    for (double along = -half; along < half; along += 0.02) {
      const double x = middle.x() + along;
      const double y = middle.y() + along;
      const double wall_y = map->origin.y() + 70.5 * kResolution;
      const double wall_x = map->origin.x() + 30.5 * kResolution;
      const Eigen::Vector2d in_row = to_dots(view, 160, 120, {x, wall_y});
      const Eigen::Vector2d in_column = to_dots(view, 160, 120, {wall_x, y});
      if (in_row.y() >= 0 && in_row.y() < 120) {
        // The dot of the wall's middle, or of the middle of its cell there.
        const double centre = (std::floor((x - map->origin.x()) / kResolution) + 0.5) * kResolution;
        EXPECT_TRUE(wall_at(picture, view, {map->origin.x() + centre, wall_y}))
            << metres_per_dot << " m a dot, x " << x;
      }
      if (in_column.x() >= 0 && in_column.x() < 160) {
        const double centre = (std::floor((y - map->origin.y()) / kResolution) + 0.5) * kResolution;
        EXPECT_TRUE(wall_at(picture, view, {wall_x, map->origin.y() + centre}))
            << metres_per_dot << " m a dot, y " << y;
      }
    }
  }
}

TEST(MapPicture, LargeCellsLeaveNoGap) {
  const auto map = room();
  const MapView view{map->origin + Eigen::Vector2d(2.0, 2.0), 0.013};
  MapPicture picture;
  picture.update(map, view, 100, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) EXPECT_NE(picture.at(x, y), MapPicture::Dot::kUnknown);
  }
}

TEST(MapPicture, HasNorthUpAndEastRight) {
  auto map = std::make_shared<GridMap>();
  map->width = map->height = 10;
  map->resolution = 1.0;
  map->cells.assign(100, -1);
  map->cells[9 * 10 + 1] = 100;  // in the north-west
  MapPicture picture;
  picture.update(map, {{5.0, 5.0}, 1.0}, 10, 10);
  EXPECT_EQ(picture.at(1, 0), MapPicture::Dot::kOccupied);
}

TEST(MapPicture, IsMadeAnewOnlyForAnotherMapOrView) {
  const auto map = room();
  MapPicture picture;
  EXPECT_TRUE(picture.update(map, {}, 20, 20));
  EXPECT_FALSE(picture.update(map, {}, 20, 20));
  EXPECT_TRUE(picture.update(map, {{1.0, 0.0}, 0.1}, 20, 20));
  EXPECT_TRUE(picture.update(room(), {{1.0, 0.0}, 0.1}, 20, 20));
  EXPECT_TRUE(picture.update(nullptr, {}, 20, 20));
  auto torn = room();
  torn->cells.resize(7);
  EXPECT_TRUE(picture.update(torn, {}, 20, 20)) << "and reads nothing beyond its end";
}

TEST(MapPicture, KnowsWhatIsKnown) {
  auto map = room();
  std::fill(map->cells.begin(), map->cells.end(), std::int8_t{-1});
  EXPECT_FALSE(known_extent(*map));
  map->cells[10 * 100 + 20] = 0;
  map->cells[40 * 100 + 25] = 100;
  const auto extent = known_extent(*map);
  ASSERT_TRUE(extent);
  EXPECT_TRUE(extent->lower.isApprox(Eigen::Vector2d(0.0, -1.5)));
  EXPECT_TRUE(extent->upper.isApprox(Eigen::Vector2d(0.3, 0.05)));
}

struct Drawn {
  Surface surface{40, 20};
  MapPicture picture;
  std::string text(bool ascii = false) const { return to_text(surface, ascii); }
};

Drawn draw(const MapScene& scene, std::shared_ptr<const GridMap> map = room()) {
  Drawn drawn;
  draw_map(Pane(drawn.surface), map, {{1.5, 1.0}, 0.08}, scene, drawn.picture);
  return drawn;
}

TEST(MapDrawing, ShowsTheVehicleAndWhereItLooks) {
  MapScene scene;
  for (const auto& [yaw, arrow] :
       std::initializer_list<std::pair<double, char32_t>>{{0.0, U'→'},
                                                          {M_PI / 2, U'↑'},
                                                          {M_PI, U'←'},
                                                          {-M_PI, U'←'},
                                                          {-M_PI / 2, U'↓'},
                                                          {M_PI / 4, U'↗'}}) {
    scene.vehicle = {{1.5, 1.0}, yaw, false};
    EXPECT_EQ(draw(scene).surface.at(20, 10).glyph, arrow) << yaw;
  }
}

TEST(MapDrawing, NumbersWaypointsAndMarksPadAndCursor) {
  MapScene scene;
  scene.waypoints = {{1, {0.0, 1.0}}, {4, {3.0, 1.0}}};
  scene.selected = 4;
  scene.pad = Eigen::Vector2d(1.5, 2.0);
  scene.cursor = Eigen::Vector2d(1.5, -0.5);
  const Drawn drawn = draw(scene);
  EXPECT_EQ(drawn.surface.at(10, 10).glyph, U'1');
  EXPECT_EQ(drawn.surface.at(29, 10).glyph, U'4');
  EXPECT_TRUE(drawn.surface.at(29, 10).style.inverse);
  EXPECT_NE(drawn.text().find('H'), std::string::npos);
  EXPECT_NE(drawn.text().find("─┼─"), std::string::npos);
}

TEST(MapDrawing, InAsciiTheWallsAreThereToo) {
  const std::string text = draw({}).text(true);
  EXPECT_NE(text.find("::::"), std::string::npos) << text;
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F && c != '?')) << text;
}

TEST(MapDrawing, TheScaleIsAsLongAsItSays) {
  const std::string text = draw({}).text();
  const std::size_t begin = text.rfind("├");
  ASSERT_NE(begin, std::string::npos);
  const std::string scale = text.substr(begin);
  // 0.16 m a column: 1 m is 6 columns, as near as columns are.
  EXPECT_NE(scale.find("├─────┤ 1 m"), std::string::npos) << scale;
}

TEST(MapDrawing, RoundLengthsAreOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(round_length(1.0), 1.0);
  EXPECT_DOUBLE_EQ(round_length(4.99), 2.0);
  EXPECT_DOUBLE_EQ(round_length(73.0), 50.0);
  EXPECT_DOUBLE_EQ(round_length(0.3), 0.2);
}

TEST(MapCamera, ShowsAllThatIsKnownAndMovesSeldom) {
  MapCamera camera;
  const Extent extent{{-1.0, -2.0}, {9.0, 4.0}};
  MapView last = camera.update(100, 60, extent, std::nullopt, std::nullopt);
  for (const Eigen::Vector2d& corner : {extent.lower, extent.upper}) {
    const Eigen::Vector2d dot = to_dots(last, 100, 60, corner);
    EXPECT_GE(dot.minCoeff(), 0.0);
    EXPECT_LT(dot.x(), 100.0);
    EXPECT_LT(dot.y(), 60.0);
  }
  int moves = 0;
  for (int i = 0; i < 100; ++i) {
    const Extent grown{extent.lower, extent.upper + Eigen::Vector2d(0.01 * i, 0.0)};
    const MapView& view = camera.update(100, 60, grown, std::nullopt, std::nullopt);
    moves += view == last ? 0 : 1;
    last = view;
  }
  EXPECT_LE(moves, 4) << "a metre in a hundred scans";
}

TEST(MapCamera, FollowsTheVehicleAndKeepsTheCursorInThePicture) {
  MapCamera camera;
  camera.update(100, 60, std::nullopt, Eigen::Vector2d(0.0, 0.0), std::nullopt);
  camera.follow();
  for (double x = 0.0; x < 50.0; x += 0.3) {
    const Eigen::Vector2d vehicle(x, -x);
    const MapView view = camera.update(100, 60, std::nullopt, vehicle, std::nullopt);
    const Eigen::Vector2d dot = to_dots(view, 100, 60, vehicle);
    EXPECT_TRUE(dot.x() > 5 && dot.x() < 95 && dot.y() > 5 && dot.y() < 55) << dot.transpose();
  }
  const Eigen::Vector2d cursor(-30.0, 7.0);
  const MapView view = camera.update(100, 60, std::nullopt, Eigen::Vector2d(50, -50), cursor);
  EXPECT_TRUE(to_dots(view, 100, 60, cursor).isApprox(Eigen::Vector2d(50, 30)));
}

TEST(MapCamera, TheCursorMovesAColumnOrALittleMore) {
  MapCamera camera;
  for (int i = 0; i < 60; ++i) {
    const double column = camera.view().metres_per_dot * Braille::kAcross;
    EXPECT_GE(camera.cursor_step(), column * (1.0 - 1e-9));
    EXPECT_LE(camera.cursor_step(), 2.6 * column);
    i < 30 ? camera.zoom_in() : camera.zoom_out();
  }
}

}  // namespace
}  // namespace swiftlet::screen
