// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/ground_link/coarse_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

nav_msgs::msg::OccupancyGrid random_map(std::mt19937& random, std::uint32_t width,
                                        std::uint32_t height) {
  nav_msgs::msg::OccupancyGrid map;
  map.info().resolution(0.05f);
  map.info().width(width);
  map.info().height(height);
  map.info().origin().position().x(-1.5);
  std::vector<std::int8_t> cells(width * height);
  for (std::int8_t& cell : cells) {
    const int value = std::uniform_int_distribution<>(-60, 100)(random);
    cell = static_cast<std::int8_t>(std::max(value, -1));
  }
  map.data(cells);
  return map;
}

TEST(CoarseMap, ACellIsAsOccupiedAsTheMostOccupiedOfThoseThatItCovers) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    const auto size = [&] { return std::uniform_int_distribution<std::uint32_t>(1, 40)(random); };
    const auto map = random_map(random, size(), size());
    const auto coarse = coarsened(map, 0.2);
    ASSERT_FLOAT_EQ(coarse.info().resolution(), 0.2f);
    ASSERT_EQ(coarse.info().width(), (map.info().width() + 3) / 4);
    ASSERT_EQ(coarse.info().height(), (map.info().height() + 3) / 4);
    EXPECT_EQ(coarse.info().origin().position().x(), -1.5);
    for (std::uint32_t y = 0; y < coarse.info().height(); ++y) {
      for (std::uint32_t x = 0; x < coarse.info().width(); ++x) {
        int most = -1;
        for (std::uint32_t v = 4 * y; v < std::min(4 * y + 4, map.info().height()); ++v) {
          for (std::uint32_t u = 4 * x; u < std::min(4 * x + 4, map.info().width()); ++u) {
            most = std::max<int>(most, map.data()[v * map.info().width() + u]);
          }
        }
        ASSERT_EQ(coarse.data()[y * coarse.info().width() + x], most);
      }
    }
  }
}

TEST(CoarseMap, TheResolutionIsAWholeMultipleAndAtLeastWhatWasAsked) {
  std::mt19937 random(4);
  const auto map = random_map(random, 30, 30);
  EXPECT_FLOAT_EQ(coarsened(map, 0.12).info().resolution(), 0.15f);
  EXPECT_FLOAT_EQ(coarsened(map, 0.1).info().resolution(), 0.1f);
}

TEST(CoarseMap, WhatCannotBeMadeCoarserStaysAsItIs) {
  std::mt19937 random(5);
  auto map = random_map(random, 12, 9);
  for (const double resolution : {0.0, 0.01, 0.05, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(coarsened(map, resolution) == map) << resolution;
  }
  map.info().width(1000);  // contradicts the number of cells
  EXPECT_TRUE(coarsened(map, 0.2) == map);
  map = random_map(random, 12, 9);
  for (const float broken : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    map.info().resolution(broken);
    EXPECT_EQ(coarsened(map, 0.2).data(), map.data());
  }
  EXPECT_EQ(coarsened(nav_msgs::msg::OccupancyGrid(), 0.2).data().size(), 0U);
}

TEST(CoarseMap, AVeryCoarseOneIsOneCell) {
  std::mt19937 random(6);
  const auto coarse = coarsened(random_map(random, 12, 9), std::numeric_limits<double>::infinity());
  EXPECT_EQ(coarse.data().size(), 1U);
}

}  // namespace
}  // namespace swiftlet
