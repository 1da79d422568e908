// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/path_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Vector3d;

/// A line flown at constant velocity: linear interpolation of it is exact.
Vector3d line(double time) {
  return {0.7 * time, -0.2 * time, 1.0};
}

TEST(PathError, IsExactBetweenReferencesThatComeLaterAndMoreSeldom) {
  std::vector<PathError::At> errors;
  PathError error(0.1, [&errors](const PathError::At& at) { errors.push_back(at); });
  Vector3d squares = Vector3d::Zero();
  int positions = 0;
  for (int i = 0; i < 1000; ++i) {
    const double time = 0.004 * i;
    const Vector3d off(0.1 * std::sin(time), 0.02, -0.03 * std::cos(3.0 * time));
    error.add_position(time, line(time) + off);
    squares += off.cwiseAbs2();
    ++positions;
    if (i % 5 == 0 && i >= 10) error.add_reference(0.004 * (i - 10), line(0.004 * (i - 10)));
  }
  for (int i = 990; i <= 1000; i += 5) error.add_reference(0.004 * i, line(0.004 * i));
  ASSERT_EQ(error.count(), static_cast<std::uint64_t>(positions));
  EXPECT_TRUE(error.rms()->isApprox((squares / positions).cwiseSqrt(), 1e-9));
  EXPECT_NEAR(errors[500].error.x(), 0.1 * std::sin(errors[500].time), 1e-9);
}

TEST(PathError, KnowsNoneWhereTheReferenceStoodStill) {
  PathError error(0.1, nullptr);
  error.add_reference(0.0, {0, 0, 0});
  for (double time = 0.05; time < 2.0; time += 0.1) error.add_position(time, {1, 0, 0});
  error.add_reference(2.0, {0, 0, 0});  // two seconds without one
  EXPECT_EQ(error.count(), 0U);
  EXPECT_FALSE(error.rms());
  error.add_position(2.02, {3, 0, 0});
  error.end_reference();
  error.add_reference(2.04, {0, 0, 0});
  EXPECT_EQ(error.count(), 0U);
  error.add_position(2.05, {3, 0, 4});
  error.add_reference(2.06, {0, 0, 0});
  EXPECT_EQ(error.count(), 1U);
  EXPECT_DOUBLE_EQ(error.largest(), 5.0);
}

TEST(Track, NoiseOfAVehicleThatHoversAddsNoLength) {
  Track track;
  for (int i = 0; i < 10'000; ++i) {
    track.add(0.01 * i, {0.01 * std::sin(i), 0.01 * std::cos(1.7 * i), 1.0});
  }
  EXPECT_LT(track.length(), Track::kStep);
}

TEST(Track, LongWaysAreDrawnInLongerStepsAndKeepTheirLength) {
  Track track;
  constexpr double kRadius = 100.0;
  constexpr int kSamples = 400'000;
  double time = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 20.0 * M_PI * i / kSamples;  // ten times around
    time = 0.1 * i;
    track.add(time, {kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0});
  }
  EXPECT_NEAR(track.length(), 20.0 * M_PI * kRadius, 1.0);
  EXPECT_LE(track.points().size(), Track::kMostPoints);
  EXPECT_GE(track.points().size(), Track::kMostPoints / 4);
  EXPECT_GT(track.points().back().time, 0.99 * time);
  for (std::size_t i = 2; i < track.points().size(); ++i) {
    const auto step = [&](std::size_t k) {
      return (track.points()[k].position - track.points()[k - 1].position).norm();
    };
    ASSERT_NEAR(step(i), step(1), 0.3 * step(1)) << i;
  }
}

}  // namespace
}  // namespace swiftlet
