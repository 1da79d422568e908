// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/plot/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace swiftlet::plot {
namespace {

using testing::HasSubstr;

class FigureTest : public testing::Test {
 protected:
  FigureTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("swiftlet-figure-") + info->name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~FigureTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Draws, and reads what was drawn.
  cv::Mat draw(const Figure& figure) const {
    const Status saved = figure.save(path("figure.png"));
    EXPECT_TRUE(saved.ok()) << saved.error().reason;
    return cv::imread(path("figure.png"));
  }

  std::filesystem::path folder_;
};

Figure line(const Style& style = {}) {
  Figure figure;
  figure.panel("A line", "time [s]", "x [m]").add("x", {0, 1, 2}, {0, 1, 0.5}, style);
  return figure;
}

/// Pixels within a little of a colour "#rrggbb". Thin lines are blended with what is behind them.
int count(const cv::Mat& image, const std::string& color, double tolerance = 12) {
  const auto part = [&](std::size_t at) { return std::stoi(color.substr(at, 2), nullptr, 16); };
  const cv::Scalar wanted(part(5), part(3), part(1)), near = cv::Scalar::all(tolerance);
  cv::Mat found;
  cv::inRange(image, wanted - near, wanted + near, found);
  return cv::countNonZero(found);
}

TEST_F(FigureTest, HasTheSizeOfItsPanels) {
  Figure figure = line();
  for (int i = 0; i < 2; ++i) figure.panels.push_back(figure.panels[0]);
  figure.columns = 2;
  figure.panel_width = 400;
  figure.panel_height = 250;
  const cv::Mat image = draw(figure);
  EXPECT_EQ(image.cols, 800);
  EXPECT_EQ(image.rows, 500);
  figure.title = "Three lines";
  EXPECT_GT(draw(figure).rows, 500);
}

TEST_F(FigureTest, DrawsSeriesInTheirColours) {
  EXPECT_GT(count(draw(line({"#00aa22"})), "#00aa22"), 300);
  EXPECT_EQ(count(draw(line({"#aa0022"})), "#00aa22"), 0);
  // Dashes are as long as the gaps between them, or so.
  constexpr double kBlended = 110;
  const int solid = count(draw(line({"#aa0022"})), "#aa0022", kBlended);
  const int dotted = count(draw(line({"#aa0022", Dash::kDotted})), "#aa0022", kBlended);
  EXPECT_GT(dotted, solid / 8);
  EXPECT_LT(dotted, solid * 3 / 4);
  const int points = count(draw(line({"#aa0022", Dash::kNoLine, Marker::kDot})), "#aa0022");
  EXPECT_GT(points, 20);
  EXPECT_LT(points, solid / 2);
}

TEST_F(FigureTest, SeriesWithoutColoursDiffer) {
  Figure figure = line();
  figure.panels[0].add("y", {0, 1, 2}, {1, 0, 1});
  const cv::Mat image = draw(figure);
  EXPECT_GT(count(image, kBlue), 200);
  EXPECT_GT(count(image, kRed), 200);
}

TEST_F(FigureTest, SpansMarksAndLevelsAreThere) {
  Figure figure = line();
  figure.panels[0].spans.push_back({0.5, 1.0, "#ffdd88"});
  figure.panels[0].levels.push_back({2.0, "limit", "#cc00cc"});
  const cv::Mat image = draw(figure);
  EXPECT_GT(count(image, "#ffdd88"), 5000);  // a quarter of the panel
  EXPECT_GT(count(image, "#cc00cc"), 150);   // the axis has room for it
  // A mark changes a line from the top to the bottom, and the place of its label.
  figure.panels[0].marks.push_back({1.5, "here"});
  cv::Mat change, changed;
  cv::absdiff(image, draw(figure), change);
  cv::cvtColor(change, changed, cv::COLOR_BGR2GRAY);
  const cv::Rect box = cv::boundingRect(changed > 20);
  EXPECT_GT(box.height, 150);
  EXPECT_LT(box.width, 60);
}

TEST_F(FigureTest, AMetreIsAsLongOnBothAxesOfAMap) {
  Figure figure;
  Panel& panel = figure.panel("Square", "x [m]", "y [m]");
  panel.equal_aspect = true;
  panel.add("", {0, 3, 3, 0, 0}, {0, 0, 3, 3, 0}, {"#aa0022"});
  const cv::Mat image = draw(figure);
  cv::Mat found;
  cv::inRange(image, cv::Scalar(0x22 - 12, 0, 0xaa - 12), cv::Scalar(0x22 + 12, 12, 0xaa + 12),
              found);
  const cv::Rect box = cv::boundingRect(found);
  EXPECT_GT(box.width, 100);
  EXPECT_NEAR(box.width, box.height, 4);
}

TEST_F(FigureTest, WhatIsNotFiniteIsAGap) {
  Figure figure;
  figure.panel("Gap", "t", "x")
      .add("", {0, 1, 2, 3, 4}, {1, 2, std::nan(""), 2, std::numeric_limits<double>::infinity()},
           {"#aa0022"});
  const int gap = count(draw(figure), "#aa0022");
  figure.panels[0].series[0].y = {1, 2, 2, 2, 1};
  EXPECT_LT(gap, count(draw(figure), "#aa0022") * 2 / 3);
  // A straight line and a single point have axes, too.
  figure.panels[0].series[0] = {"", {1.0}, {0.0}, {"#aa0022", Dash::kNoLine, Marker::kDot}};
  EXPECT_GT(count(draw(figure), "#aa0022"), 5);
}

TEST_F(FigureTest, TextIsNeverACommand) {
  Figure figure = line();
  const std::string file = path("made");
  for (const std::string& text :
       {"`touch " + file + "`", "'; system('touch " + file + "'); '",
        "\"; system(\"touch " + file + "\"); \"", "a\nsystem('touch " + file + "')\nb",
        std::string("100 % of m/s² {x}^2_i @ & ~ \\ \\n")}) {
    figure.title = figure.panels[0].title = figure.panels[0].x_label = text;
    figure.panels[0].series[0].label = text;
    figure.panels[0].notes = {{1.0, 0.5, text}};
    EXPECT_FALSE(draw(figure).empty()) << text;
    EXPECT_FALSE(std::filesystem::exists(file)) << text;
  }
}

TEST_F(FigureTest, SaysWhatIsMissing) {
  const auto reason = [&](const Figure& figure) {
    const Status saved = figure.save(path("none.png"));
    EXPECT_FALSE(saved.ok());
    return saved.ok() ? "" : saved.error().reason;
  };
  EXPECT_THAT(reason(Figure()), HasSubstr("no panels"));
  Figure empty;
  empty.panel("Nothing", "x", "y");
  EXPECT_THAT(reason(empty), HasSubstr("'Nothing'"));
  Figure uneven = line();
  uneven.panels[0].series[0].y.pop_back();
  EXPECT_THAT(reason(uneven), HasSubstr("3 values of x and 2 of y"));
  EXPECT_FALSE(std::filesystem::exists(path("none.png")));
  const Status nowhere = line().save(path("no/folder/figure.png"));
  ASSERT_FALSE(nowhere.ok());
  EXPECT_THAT(nowhere.error().reason, HasSubstr("no/folder/figure.png: cannot be written"));
}

TEST_F(FigureTest, SaysWhatToInstallWhereGnuplotIsNot) {
  const std::string path_before = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  const Status saved = line().save(path("figure.png"));
  setenv("PATH", path_before.c_str(), 1);
  ASSERT_FALSE(saved.ok());
  EXPECT_THAT(saved.error().reason, HasSubstr("install the package gnuplot-nox"));
}

}  // namespace
}  // namespace swiftlet::plot
