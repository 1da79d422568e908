// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/plan_view.hpp"

#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "components/sim/world.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

class PlanViewTest : public testing::Test {
 protected:
  PlanViewTest() {
    view.title = "office";
    view.outlines = {{"wall", false, true, {{0, 0}, {4, 0}, {4, 1}, {0, 1}}}};
    view.flown = {{0, 2, 1}, {4, 2, 1}};
    view.pad_size = 0.0;
    view.pixels_per_metre = 100;
  }
  cv::Mat draw() {
    const auto file = folder.path() / "flight.png";
    EXPECT_TRUE(draw_plan_view(view, file).ok());
    return cv::imread(file.string());
  }
  static double brightness(const cv::Mat& image, int x, int y) {
    const auto& pixel = image.at<cv::Vec3b>(y, x);
    return (pixel[0] + pixel[1] + pixel[2]) / 3.0;
  }
  test::TemporaryFolder folder;
  PlanView view;
};

TEST_F(PlanViewTest, DrawsToScaleWithNorthUp) {
  const cv::Mat image = draw();
  ASSERT_FALSE(image.empty());
  // The rows and columns of the dark wall, found in the picture: 4 m x 1 m at 100 pixels a metre.
  cv::Mat dark;
  cv::inRange(image, cv::Scalar(70, 55, 45), cv::Scalar(95, 78, 65), dark);
  cv::Mat map = dark(cv::Rect(0, 60, dark.cols, dark.rows - 60 - 80));
  const cv::Rect box = cv::boundingRect(map);
  EXPECT_NEAR(box.width, 400, 4);
  EXPECT_NEAR(box.height, 100, 4);
  // The path runs 1 m above the upper edge of the wall.
  const int path_row = 60 + box.y - 100;
  const auto& colour = image.at<cv::Vec3b>(path_row, box.x + 200);
  EXPECT_GT(std::abs(colour[0] - colour[2]), 60) << "a saturated colour";
}

TEST_F(PlanViewTest, SpeedColoursThePath) {
  view.flown = {{0, 2, 1}, {2, 2, 1}, {4, 2, 1}};
  view.flown_speed = {0.1, 0.1, 1.0};
  const cv::Mat fast = draw();
  view.flown_speed = {0.1, 1.0, 1.0};
  EXPECT_GT(cv::norm(fast, draw(), cv::NORM_L1), 10000.0);
}

TEST_F(PlanViewTest, WhatIsNotFiniteIsLeftOut) {
  const cv::Mat clean = draw();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  view.flown.emplace_back(nan, 1.0, 1.0);
  view.reference.emplace_back(nan, nan, nan);
  view.waypoints.emplace_back(nan, 0.0);
  view.collisions.emplace_back(0.0, std::numeric_limits<double>::infinity());
  view.outlines.push_back({"odd", false, true, {{nan, 0}, {1, 1}, {2, 0}}});
  EXPECT_EQ(draw().size(), clean.size());
}

TEST_F(PlanViewTest, ALargeWorldIsScaledDown) {
  view.outlines[0].points = {{0, 0}, {400, 0}, {400, 100}, {0, 100}};
  EXPECT_LE(draw().cols, 4200);
  view.outlines[0].points = {{0, 0}, {1e7, 0}, {1e7, 100}, {0, 100}};
  EXPECT_FALSE(draw_plan_view(view, folder.path() / "flight.png").ok());
}

TEST_F(PlanViewTest, FailuresSayWhy) {
  const Status lost = draw_plan_view(view, folder.path() / "no/such/folder/flight.png");
  ASSERT_FALSE(lost.ok());
  EXPECT_THAT(lost.error().reason, testing::HasSubstr("no/such/folder/flight.png"));
  EXPECT_FALSE(draw_plan_view(view, folder.path() / "flight.nonsense").ok());
  const Status empty = draw_plan_view({}, folder.path() / "flight.png");
  ASSERT_FALSE(empty.ok());
  EXPECT_THAT(empty.error().reason, testing::HasSubstr("nothing to draw"));
}

}  // namespace
}  // namespace swiftlet
