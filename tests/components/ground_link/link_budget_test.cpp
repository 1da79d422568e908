// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/ground_link/link_budget.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 20ms;

Cdr payload(std::uint8_t mark) {
  return Cdr{mark};
}

/// Offers each topic at its own rate for `seconds`, and serves the link every tick.
struct Source {
  double rate_hz;
  double bytes;
};
void run(LinkBudget& budget, const std::vector<Source>& sources, double seconds, Time& now) {
  const Time end = now + from_seconds(seconds);
  std::vector<Time> next(sources.size(), now);
  for (; now < end; now += kTick) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      for (; next[i] <= now; next[i] += from_seconds(1.0 / sources[i].rate_hz)) {
        budget.offer(i, payload(0), sources[i].bytes);
      }
    }
    budget.depart(now);
  }
}

TEST(LinkBudget, WhatFitsPassesUntouchedAndInOrder) {
  LinkBudget budget({10'000.0, 0.25, 32}, {{}, {}});
  Time now{};
  for (std::uint8_t i = 0; i < 5; ++i) budget.offer(0, payload(i), 10.0);
  budget.offer(1, payload(9), 10.0);
  const auto departures = budget.depart(now);
  ASSERT_EQ(departures.size(), 6U);
  for (std::uint8_t i = 0; i < 5; ++i) {
    EXPECT_EQ(departures[i].topic, 0U);
    EXPECT_EQ(departures[i].message, payload(i));
  }
  EXPECT_EQ(departures[5].topic, 1U);
}

TEST(LinkBudget, ATopicCrossesAtItsRateAndTheNewestOfIt) {
  LinkBudget budget({1e6, 0.25, 32}, {{5.0, false, false}});
  Time now{};
  run(budget, {{100.0, 100.0}}, 20.0, now);
  EXPECT_NEAR(static_cast<double>(budget.counts(0).sent), 100.0, 1.0);
  EXPECT_EQ(budget.counts(0).over_budget, 0U) << "a rate that was asked for is no want of budget";
  EXPECT_GE(budget.counts(0).thinned, 1850U);

  now += 1s;
  budget.offer(0, payload(1), 100.0);
  budget.offer(0, payload(2), 100.0);
  const auto departures = budget.depart(now);
  ASSERT_EQ(departures.size(), 1U);
  EXPECT_EQ(departures[0].message, payload(2));
}

TEST(LinkBudget, TheBudgetIsKeptWhateverIsOffered) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const double bytes_per_s = std::uniform_real_distribution<>(500.0, 50'000.0)(random);
    std::vector<Source> sources;
    std::vector<LinkTopic> topics;
    double largest = 0.0;
    for (int i = 0; i < 4; ++i) {
      sources.push_back({std::uniform_real_distribution<>(0.5, 100.0)(random),
                         std::uniform_real_distribution<>(50.0, 20'000.0)(random)});
      topics.push_back({i % 2 == 0 ? 0.0 : 10.0, false, false});
      largest = std::max(largest, sources.back().bytes);
    }
    LinkBudget budget({bytes_per_s, 0.25, 32}, topics);
    Time now{};
    run(budget, sources, 60.0, now);
    double sent = 0.0;
    for (std::size_t i = 0; i < topics.size(); ++i) {
      sent += static_cast<double>(budget.counts(i).sent_bytes);
    }
    // The burst at the beginning, and one message that overdraws the account.
    EXPECT_LE(sent, bytes_per_s * 60.25 + largest) << "trial " << trial;
  }
}

TEST(LinkBudget, EssentialMessagesAllCrossAndTheRestShareWhatRemains) {
  LinkBudget budget({10'000.0, 0.25, 32}, {{0.0, false, false}, {10.0, true, false}});
  Time now{};
  run(budget, {{100.0, 1000.0}, {10.0, 400.0}}, 30.0, now);
  EXPECT_NEAR(static_cast<double>(budget.counts(1).sent), 300.0, 1.0);
  EXPECT_EQ(budget.counts(1).over_budget, 0U);
  // 10,000 minus 4,000 bytes a second are left: 6 of 100 messages.
  EXPECT_NEAR(static_cast<double>(budget.counts(0).sent), 180.0, 6.0);
  EXPECT_NEAR(static_cast<double>(budget.counts(0).over_budget), 3000.0 - 180.0, 40.0);
}

TEST(LinkBudget, EssentialMessagesDoNotWaitForALargeOneToBePaidFor) {
  LinkBudget budget({1'000.0, 0.25, 32}, {{}, {5.0, true, false}});
  Time now{};
  budget.offer(0, payload(0), 100'000.0);
  ASSERT_EQ(budget.depart(now).size(), 1U);
  for (int i = 0; i < 20; ++i) {
    now += 200ms;
    budget.offer(1, payload(1), 100.0);
    EXPECT_EQ(budget.depart(now).size(), 1U) << i;
  }
}

TEST(LinkBudget, WhatStandsFirstIsServedFirst) {
  LinkBudget budget({1'000.0, 0.25, 4}, {{10.0, false, false}, {10.0, false, false}});
  Time now{};
  run(budget, {{10.0, 95.0}, {10.0, 95.0}}, 30.0, now);
  EXPECT_NEAR(static_cast<double>(budget.counts(0).sent), 300.0, 2.0);
  EXPECT_LT(budget.counts(1).sent, 30U);
  EXPECT_GT(budget.counts(1).over_budget, 250U) << "thinned, and visibly so";
}

TEST(LinkBudget, ALatchedMessageIsNeverLostForGood) {
  LinkBudget budget({1'000.0, 0.25, 32}, {{0.0, false, false}, {0.0, false, true}});
  Time now{};
  // A map far larger than what may be sent at once, after which the account is overdrawn.
  budget.offer(1, payload(1), 20'000.0);
  ASSERT_EQ(budget.depart(now).size(), 1U);
  budget.offer(1, payload(2), 20'000.0);
  budget.offer(1, payload(3), 20'000.0);
  Cdr arrived;
  double waited = 0.0;
  for (; arrived.empty() && waited < 60.0; waited += to_seconds(kTick)) {
    now += kTick;
    for (const auto& departure : budget.depart(now)) arrived = departure.message;
  }
  EXPECT_EQ(arrived, payload(3)) << "the newest";
  EXPECT_NEAR(waited, 19.75, 0.5) << "once the first is paid for";
  EXPECT_EQ(budget.counts(1).over_budget, 1U);
}

TEST(LinkBudget, AQueueIsBounded) {
  LinkBudget budget({1'000.0, 0.25, 8}, {{}});
  for (int i = 0; i < 1000; ++i) budget.offer(0, payload(0), 1e6);
  EXPECT_EQ(budget.counts(0).over_budget, 992U);
  EXPECT_EQ(budget.depart(Time{}).size(), 1U);
}

}  // namespace
}  // namespace swiftlet
