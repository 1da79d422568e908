// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/event_log.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin(1000s);

/// When a reader who looks after each event is told of it.
std::vector<double> told_at(Severity severity, Duration period, int count) {
  EventLog log;
  std::vector<double> told;
  for (int i = 0; i < count; ++i) {
    log.add(kBegin + i * period, severity, "it comes and goes");
    if (is_news(log.events().back())) told.push_back(to_seconds(i * period));
  }
  return told;
}

TEST(News, TheSameAgainIsToldOfEveryTenSecondsThoughItComesTenTimesASecond) {
  EXPECT_THAT(told_at(Severity::kCaution, 100ms, 301), testing::ElementsAre(0.0, 10.0, 20.0, 30.0));
  EXPECT_THAT(told_at(Severity::kDanger, 3s, 8), testing::ElementsAre(0.0, 12.0, 21.0));
}

TEST(News, WhatIsRareIsToldOfEachTime) {
  EXPECT_EQ(told_at(Severity::kCaution, 11s, 5).size(), 5u);
}

TEST(EventLog, NumbersGrowAndTheSameAgainTakesTheNewest) {
  EventLog log;
  log.add(kBegin, Severity::kCaution, "a");
  log.add(kBegin + 1s, Severity::kNote, "b");
  log.add(kBegin + 2s, Severity::kCaution, "a");
  ASSERT_EQ(log.events().size(), 2u);
  EXPECT_EQ(log.events().front().number, 2u);
  EXPECT_EQ(log.events().back().number, 3u);
  EXPECT_EQ(log.events().back().begun, kBegin);
  EXPECT_EQ(text_of(log.events().back()), "a ×2");
  EXPECT_EQ(text_of(log.events().front()), "b");
}

}  // namespace
}  // namespace swiftlet::screen
