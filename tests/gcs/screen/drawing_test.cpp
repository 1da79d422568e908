// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "estimation/geometry/so3.hpp"
#include "gcs/screen/drawing/braille.hpp"
#include "gcs/screen/drawing/horizon.hpp"
#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/drawing/widgets.hpp"

namespace swiftlet::screen {
namespace {

using testing::ElementsAre;

TEST(Surface, CutsOffWhatDoesNotFit) {
  Surface surface(6, 2);
  const Pane pane(surface);
  EXPECT_EQ(pane.text(0, 0, "abcdefgh"), 6);
  pane.part({4, 1, 9, 9}).text(0, 0, "xyz");
  pane.put(-1, 0, U'!');
  pane.put(6, 1, U'!');
  EXPECT_EQ(to_text(surface), "abcde…\n    x…\n");
}

TEST(Surface, TakesBadUtf8AndControlsForWhatTheyAre) {
  EXPECT_EQ(decode("a\x1b[31m"), U"a\uFFFD[31m");
  EXPECT_EQ(decode("\xC3"), U"\uFFFD");
  EXPECT_EQ(decode("\xFFz"), U"\uFFFDz");
  EXPECT_EQ(decode("\xC2\x9Bq"), U"\uFFFDq") << "CSI in one byte";
  for (const char32_t glyph : {U'a', U'é', U'→', U'⣿', char32_t{0x1F681}}) {
    EXPECT_EQ(decode(encode(glyph)), std::u32string(1, glyph));
  }
}

TEST(Surface, HasAPlainFormOfEverythingThatIsDrawn) {
  Surface surface(20, 5);
  const Pane pane(surface);
  pane.box("T");
  draw_bar(pane, 2, 2, 4, 0.5, kPlain);
  pane.text(8, 2, "↑→↓←°·×…");
  for (const char c : to_text(surface, true)) {
    EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F && c != '?'));
  }
}

TEST(Braille, PutsEachDotWhereUnicodeHasIt) {
  // Unicode numbers the dots 1 2 3 7 on the left and 4 5 6 8 on the right, from above.
  const char32_t expected[4][2] = {{U'⠁', U'⠈'}, {U'⠂', U'⠐'}, {U'⠄', U'⠠'}, {U'⡀', U'⢀'}};
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 2; ++x) {
      Braille dots(2, 2);
      dots.dot(2 + x, 4 + y);
      Surface surface(2, 2);
      dots.draw(Pane(surface), {kPlain});
      EXPECT_EQ(surface.at(1, 1).glyph, expected[y][x]) << x << " " << y;
      EXPECT_EQ(surface.at(0, 0).glyph, U' ');
    }
  }
}

TEST(Braille, ALineHasADotInEveryColumnItGoesThrough) {
  Braille dots(10, 5);
  dots.line(-1e9, 3.5, 1e9, 3.5);
  for (int x = 0; x < dots.width(); ++x) EXPECT_TRUE(dots.has(x, 3)) << x;
  Braille steep(10, 5);
  steep.line(2.5, 0.5, 7.5, 19.5);
  for (int y = 0; y < steep.height(); ++y) {
    bool any = false;
    for (int x = 0; x < steep.width(); ++x) any = any || steep.has(x, y);
    EXPECT_TRUE(any) << y;
  }
  steep.line(std::nan(""), 0.0, 1.0, 1.0);  // nothing to draw, and no end to wait for
}

TEST(Braille, TheHighestLayerOfACellHasTheStyle) {
  Braille dots(1, 1);
  dots.dot(0, 0, 1);
  dots.dot(1, 1, 0);
  Surface surface(1, 1);
  dots.draw(Pane(surface), {kDim, kBold});
  EXPECT_EQ(surface.at(0, 0).style, kBold);
}

Eigen::Quaterniond attitude(double roll, double pitch_up) {
  return from_yaw(0.7) * Eigen::AngleAxisd(-pitch_up, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

constexpr int kWide = 21;
constexpr int kHigh = 9;

/// The row of the horizon's line at a column; -1 where it is not in the picture.
int line_row(const Eigen::Quaterniond& q_WB, int column) {
  Surface surface(kWide, kHigh);
  draw_horizon(Pane(surface), q_WB);
  for (int y = 0; y < kHigh; ++y) {
    if (surface.at(column, y).style.hue == Hue::kCyan) return y;
  }
  return -1;
}

TEST(Horizon, IsLevelInTheMiddleWhenTheVehicleIsLevel) {
  for (const int column : {0, 2, 18, 20}) EXPECT_EQ(line_row(attitude(0, 0), column), kHigh / 2);
}

TEST(Horizon, RisesOnTheRightWhenTheRightSideIsDown) {
  const auto right_down = attitude(0.25, 0.0);
  EXPECT_LT(line_row(right_down, kWide - 2), line_row(right_down, 1));
  const auto left_down = attitude(-0.25, 0.0);
  EXPECT_GT(line_row(left_down, kWide - 2), line_row(left_down, 1));
}

TEST(Horizon, SinksWhenTheNoseIsUpAndLeavesThePictureAtItsEdge) {
  EXPECT_GT(line_row(attitude(0.0, 0.2), 1), kHigh / 2);
  EXPECT_LT(line_row(attitude(0.0, -0.2), 1), kHigh / 2);
  EXPECT_EQ(line_row(attitude(0.0, 0.95 * kHorizonView), 1), kHigh - 1);
  EXPECT_EQ(line_row(attitude(0.0, 1.1 * kHorizonView), 1), -1);
}

TEST(Horizon, HasTheGroundAboveWhenTheVehicleIsUpsideDown) {
  Surface surface(kWide, kHigh);
  draw_horizon(Pane(surface), attitude(M_PI, 0.0));
  int above = 0;
  int below = 0;
  for (int x = 0; x < kWide; ++x) {
    for (int y = 0; y < kHigh; ++y) {
      if (!surface.at(x, y).style.dim) continue;
      (y < kHigh / 2 ? above : below) += 1;
    }
  }
  EXPECT_GT(above, 20);
  EXPECT_EQ(below, 0);
}

TEST(Horizon, DrawsOnlyItsMarkWithoutAnAttitude) {
  Surface surface(kWide, kHigh);
  draw_horizon(Pane(surface), Eigen::Quaterniond(0, 0, 0, 0));
  for (int x = 0; x < kWide; ++x) EXPECT_EQ(surface.at(x, 0).glyph, U' ');
}

TEST(Widgets, ABarIsAsFullAsItsShare) {
  const auto full = [](double share) {
    Surface surface(10, 1);
    draw_bar(Pane(surface), 0, 0, 10, share, kPlain);
    int count = 0;
    for (int x = 0; x < 10; ++x) count += surface.at(x, 0).glyph == U'█' ? 1 : 0;
    return count;
  };
  EXPECT_EQ(full(0.0), 0);
  EXPECT_EQ(full(0.5), 5);
  EXPECT_EQ(full(1.0), 10);
  EXPECT_EQ(full(7.0), 10);
  EXPECT_EQ(full(std::nan("")), 0);
}

TEST(Widgets, WrapsAtWords) {
  EXPECT_THAT(wrap("no path to waypoint 2", 8), ElementsAre("no path", "to", "waypoint", "2"));
  EXPECT_THAT(wrap("", 8), ElementsAre());
  EXPECT_THAT(wrap("in /a/long/päth.yaml: x", 8),
              ElementsAre("in", "/a/long/", "päth.yam", "l: x"));
}

TEST(Widgets, AListShowsTheSelectedLine) {
  std::vector<Line> lines;
  for (int i = 0; i < 50; ++i) lines.push_back({std::to_string(i), kPlain});
  for (const int selected : {0, 1, 25, 48, 49}) {
    Surface surface(4, 5);
    draw_list(Pane(surface), lines, selected);
    const std::string text = "\n" + to_text(surface);
    EXPECT_NE(text.find("\n" + std::to_string(selected) + "\n"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace swiftlet::screen
