// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/thinned_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

TEST(ThinnedCurve, KeepsEveryPeakAndNoMoreThanTwoPointsAColumn) {
  constexpr int kSamples = 100'000;
  constexpr int kColumns = 50;
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  ThinnedCurve curve(100.0, 1.0, kColumns);
  std::vector<double> smallest(kColumns, 1e9), largest(kColumns, -1e9);
  for (int i = 0; i < kSamples; ++i) {
    const double time = 1e-3 * i;
    const double value = i == 31'234 ? 77.0 : noise(random);
    const auto column = static_cast<std::size_t>(time / 2.0);
    smallest[column] = std::min(smallest[column], value);
    largest[column] = std::max(largest[column], value);
    curve.add(time, value);
  }
  const auto points = curve.points();
  EXPECT_LE(points.size(), 2U * kColumns);
  std::vector<double> drawn_smallest(kColumns, 1e9), drawn_largest(kColumns, -1e9);
  for (const CurvePoint& point : points) {
    const auto column = static_cast<std::size_t>(point.time / 2.0);
    drawn_smallest[column] = std::min(drawn_smallest[column], point.value);
    drawn_largest[column] = std::max(drawn_largest[column], point.value);
    if (point.value == 77.0) {
      EXPECT_DOUBLE_EQ(point.time, 31.234);
    }
  }
  EXPECT_EQ(drawn_smallest, smallest);
  EXPECT_EQ(drawn_largest, largest);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end(),
                             [](const auto& a, const auto& b) { return a.time < b.time; }));
}

TEST(ThinnedCurve, LeavesFewSamplesAsTheyAre) {
  ThinnedCurve curve(10.0, 5.0, 100);
  for (int i = 0; i < 10; ++i) curve.add(i, i * i);
  const auto points = curve.points();
  ASSERT_EQ(points.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(points[static_cast<std::size_t>(i)].time, i);
    EXPECT_EQ(points[static_cast<std::size_t>(i)].value, i * i);
    EXPECT_EQ(points[static_cast<std::size_t>(i)].begins, i == 0);
  }
}

TEST(ThinnedCurve, BreaksWhereNothingCameAndWhereNothingIsANumber) {
  ThinnedCurve curve(10.0, 0.5, 10);
  for (const double time : {0.0, 0.4, 0.8}) curve.add(time, time);
  for (const double time : {2.0, 2.2}) curve.add(time, -time);  // after a gap
  curve.add(2.3, std::numeric_limits<double>::quiet_NaN());
  curve.add(2.4, 5.0);  // in the same column, and a line of its own
  std::vector<double> beginnings;
  for (const CurvePoint& point : curve.points()) {
    if (point.begins) beginnings.push_back(point.time);
  }
  EXPECT_THAT(beginnings, testing::ElementsAre(0.0, 2.0, 2.4));
  EXPECT_EQ(curve.samples(), 6U);
}

TEST(AngleLine, HeadingOfHalfATurnIsNoSaw) {
  AngleLine line;
  int jumps = 0;
  for (int i = 0; i < 1000; ++i) {
    const double heading = 180.0 + 3.0 * std::sin(0.7 * i);
    const auto angle = line.next(std::remainder(heading, 360.0));
    jumps += angle.jumped ? 1 : 0;
    EXPECT_NEAR(std::remainder(angle.value - heading, 360.0), 0.0, 1e-9);
  }
  EXPECT_LE(jumps, 1);
}

TEST(AngleLine, TurnsStayWithinReachAndJumpOnceEach) {
  AngleLine line;
  int jumps = 0;
  for (int degrees = 0; degrees <= 5 * 360; ++degrees) {
    const auto angle = line.next(std::remainder(degrees, 360.0));
    EXPECT_LE(std::abs(angle.value), 190.0);
    jumps += angle.jumped ? 1 : 0;
  }
  EXPECT_EQ(jumps, 5);
}

}  // namespace
}  // namespace swiftlet
