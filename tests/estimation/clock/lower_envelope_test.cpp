// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/clock/lower_envelope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

bool is_below_all(const EnvelopeLine& line, const std::vector<EnvelopePoint>& points) {
  return std::all_of(points.begin(), points.end(), [&](const EnvelopePoint& point) {
    return point.y - line.at(point.x) >= -1e-9;
  });
}

/// The highest line of that slope that no point is below.
EnvelopeLine touching(double slope, const std::vector<EnvelopePoint>& points) {
  double intercept = std::numeric_limits<double>::max();
  for (const EnvelopePoint& point : points) {
    intercept = std::min(intercept, point.y - slope * point.x);
  }
  return {intercept, slope};
}

/// The best one touches two points, or has the steepest slope.
double highest(const std::vector<EnvelopePoint>& points, double max_slope, double x) {
  std::vector<double> slopes{-max_slope, max_slope};
  for (const EnvelopePoint& a : points) {
    for (const EnvelopePoint& b : points) {
      const double slope = (b.y - a.y) / (b.x - a.x);
      if (a.x < b.x && std::abs(slope) <= max_slope) slopes.push_back(slope);
    }
  }
  double height = std::numeric_limits<double>::lowest();
  for (const double slope : slopes) height = std::max(height, touching(slope, points).at(x));
  return height;
}

TEST(LowerEnvelope, IsTheHighestLineThatNoPointIsBelow) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int run = 0; run < 500; ++run) {
    std::vector<EnvelopePoint> points;
    double x = 10.0 * unit(random);
    const int count = 1 + static_cast<int>(random() % 30);
    const double steepness = 3.0 * (unit(random) - 0.5);
    for (int i = 0; i < count; ++i) {
      x += 0.01 + unit(random);
      points.push_back({x, steepness * x - std::log(1.0 - unit(random))});
    }
    for (const double max_slope : {0.5, 10.0}) {
      const double at = points.front().x + unit(random) * (x - points.front().x);
      const EnvelopeLine line = lower_envelope(points, max_slope, at);
      ASSERT_LE(std::abs(line.slope), max_slope);
      ASSERT_TRUE(is_below_all(line, points)) << run;
      ASSERT_NEAR(line.at(at), highest(points, max_slope, at), 1e-9) << run;
    }
  }
}

TEST(LowerEnvelope, IsTheLineItselfWhereThePointsLieOnOne) {
  std::vector<EnvelopePoint> points;
  for (int i = 0; i < 100; ++i) points.push_back({1.0 * i, 3.0 - 0.25 * i});
  const EnvelopeLine line = lower_envelope(points, 1.0, 50.0);
  EXPECT_NEAR(line.slope, -0.25, 1e-12);
  EXPECT_NEAR(line.intercept, 3.0, 1e-9);
}

}  // namespace
}  // namespace swiftlet
