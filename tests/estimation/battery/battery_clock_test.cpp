// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/battery/battery_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin{100s};
const double kNan = std::nan("");

TEST(BatteryClock, DividesTheChargeByTheCurrent) {
  BatteryClock clock;
  EXPECT_FALSE(clock.seconds_left(kBegin));
  for (int i = 0; i < 20; ++i) {
    clock.add({0.5, 15.0, i % 2 == 0 ? 9.0 : 11.0, 2.0}, kBegin + i * 1s);
  }
  const Time last = kBegin + 19s;
  ASSERT_TRUE(clock.seconds_left(last));
  EXPECT_NEAR(*clock.seconds_left(last), 2.0 / 10.0 * 3600.0, 1.0);
  EXPECT_NEAR(*clock.seconds_left(last + 5s), 2.0 / 10.0 * 3600.0 - 5.0, 1.0);
  EXPECT_FALSE(clock.seconds_left(last + 11s)) << "it was not heard for long";
}

TEST(BatteryClock, TakesTheSlopeWhereNoChargeIsMeasured) {
  BatteryClock clock, idle;
  for (int i = 0; i <= 60; ++i) {
    const Time now = kBegin + i * 1s;
    clock.add({0.8 - 0.001 * i, 15.0, kNan, kNan}, now);
    idle.add({0.8, 15.0, kNan, kNan}, now);
    if (i < 5) {
      EXPECT_FALSE(clock.seconds_left(now)) << i;
    }
  }
  ASSERT_TRUE(clock.seconds_left(kBegin + 60s));
  EXPECT_NEAR(*clock.seconds_left(kBegin + 60s), 740.0, 5.0);
  EXPECT_FALSE(idle.seconds_left(kBegin + 60s)) << "nothing is used, so nothing is known";
}

TEST(BatteryClock, NothingIsDrawnSoNothingIsKnown) {
  BatteryClock clock;
  for (int i = 0; i <= 60; ++i) clock.add({0.8, 16.0, 0.02, 2.0}, kBegin + i * 1s);
  EXPECT_FALSE(clock.seconds_left(kBegin + 60s));
}

}  // namespace
}  // namespace swiftlet
