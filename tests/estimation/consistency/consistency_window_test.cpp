// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/consistency/consistency_window.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swiftlet {
namespace {

TEST(ChiSquareQuantile, IsThatOfTheTables) {
  // Quantiles 2.5 % and 97.5 %, as printed in any table.
  EXPECT_NEAR(chi_square_quantile(6, 1.959964), 14.449, 0.03);
  EXPECT_NEAR(chi_square_quantile(6, -1.959964), 1.237, 0.035);
  EXPECT_NEAR(chi_square_quantile(100, 1.959964), 129.561, 0.02);
  EXPECT_NEAR(chi_square_quantile(100, -1.959964), 74.222, 0.02);
}

TEST(ConsistencyWindow, NineteenOfTwentyConsistentWindowsAreInTheBand) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  int inside = 0, inside_optimistic = 0;
  constexpr int kWindows = 2000;
  for (int i = 0; i < kWindows; ++i) {
    ConsistencyWindow honest(6), optimistic(6);
    for (int k = 0; k < 30; ++k) {
      double square = 0.0;
      for (int axis = 0; axis < 6; ++axis) square += std::pow(normal(random), 2);
      honest.add(square);
      optimistic.add(1.5 * square);  // the covariance is a third too small
    }
    inside += honest.mean() > honest.low() && honest.mean() < honest.high();
    inside_optimistic +=
        optimistic.mean() > optimistic.low() && optimistic.mean() < optimistic.high();
  }
  EXPECT_NEAR(inside / double(kWindows), 0.95, 0.015);
  EXPECT_LT(inside_optimistic, kWindows / 20);
}

TEST(ConsistencyWindow, ClearedItIsAsNew) {
  ConsistencyWindow window(3);
  EXPECT_EQ(window.mean(), 0.0);
  window.add(5.0);
  window.clear();
  window.add(2.0);
  EXPECT_EQ(window.count(), 1);
  EXPECT_EQ(window.mean(), 2.0);
}

}  // namespace
}  // namespace swiftlet
