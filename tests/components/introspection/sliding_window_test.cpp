// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/sliding_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace swiftlet {
namespace {

TEST(SlidingWindow, HasTheMomentsOfTheLastValues) {
  constexpr std::size_t kLongest = 50;
  SlidingWindow window(kLongest);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(0.5, 2.0);
  std::vector<double> all;
  for (int i = 0; i < 200; ++i) {
    all.push_back(value(random));
    window.add(Time(Duration(i)), all.back());
    const std::size_t count = std::min(all.size(), kLongest);
    const std::vector<double> last(all.end() - static_cast<long>(count), all.end());
    const double mean = std::accumulate(last.begin(), last.end(), 0.0) / double(count);
    double squares = 0.0;
    for (const double each : last) squares += (each - mean) * (each - mean);
    const Spread spread = window.spread();
    ASSERT_EQ(spread.count, count);
    EXPECT_NEAR(spread.mean, mean, 1e-12);
    EXPECT_EQ(spread.min, *std::min_element(last.begin(), last.end()));
    EXPECT_EQ(spread.max, *std::max_element(last.begin(), last.end()));
    EXPECT_NEAR(spread.deviation, std::sqrt(squares / double(count)), 1e-12);
    EXPECT_EQ(window.oldest(), last.front());
    EXPECT_EQ(window.age(Time(Duration(i))), Duration(count - 1));
  }
}

}  // namespace
}  // namespace swiftlet
