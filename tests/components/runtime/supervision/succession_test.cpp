// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/succession.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 20ms;
constexpr Duration kStep = 1ms;
constexpr Duration kSettle = 500ms;

/// Instances that send each other signs of life. A stopped one does nothing until it goes on.
struct Group {
  struct Instance {
    Succession succession;
    bool running = true;
    Duration phase{};
  };
  std::vector<std::unique_ptr<Instance>> all;
  Time now{10s};
  bool cut = false;  // no sign gets through

  void add(int standby, Duration phase = 0ms) {
    const Succession::Sign self{"p" + std::to_string(all.size()), standby, false, 0};
    all.push_back(std::make_unique<Instance>(
        Instance{Succession(self, kPeriod, kSettle + standby * 1s, now), true, phase}));
  }

  void run(Duration time) {
    for (const Time end = now + time; now < end; now += kStep) {
      for (const auto& instance : all) {
        const bool due = (now.time_since_epoch() + instance->phase) % kPeriod == 0ms;
        if (!instance->running || !due) continue;
        instance->succession.update(now);
        for (const auto& other : all) {
          if (other->running && !cut) other->succession.heard(instance->succession.self(), now);
        }
      }
    }
  }

  bool active(std::size_t i) const { return all[i]->running && all[i]->succession.active(); }
  int active_count() const {
    int count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) count += active(i) ? 1 : 0;
    return count;
  }
};

TEST(Succession, TheFirstInLineBeginsAfterItHasListened) {
  Group group;
  group.add(1);
  group.add(0);
  group.run(kSettle - 1ms);
  EXPECT_EQ(group.active_count(), 0);
  group.run(2 * kPeriod);
  EXPECT_TRUE(group.active(1));
  group.run(5s);
  EXPECT_FALSE(group.active(0));
}

TEST(Succession, TheNextInLineTakesOverWithinFourPeriods) {
  Group group;
  for (const int standby : {0, 1, 2}) group.add(standby, standby * 7ms);
  group.run(5s);
  group.all[0]->running = false;
  group.run(2 * kPeriod - 1ms);
  EXPECT_EQ(group.active_count(), 0) << "three periods after its last sign are for other reasons";
  group.run(2 * kPeriod + 2ms);
  EXPECT_TRUE(group.active(1));
  EXPECT_FALSE(group.active(2));
  group.all[1]->running = false;
  group.run(4 * kPeriod + 2ms);
  EXPECT_TRUE(group.active(2));
}

TEST(Succession, OneThatComesBackFromAStopGivesWayToItsSuccessor) {
  Group group;
  group.add(0);
  group.add(1, 3ms);
  group.run(5s);
  group.all[0]->running = false;  // keeps believing that it is active
  group.run(1s);
  group.all[0]->running = true;
  group.run(2 * kPeriod);
  EXPECT_FALSE(group.active(0));
  EXPECT_TRUE(group.active(1));
  group.run(5s);
  EXPECT_TRUE(group.active(1)) << "nothing is handed back without need";
}

TEST(Succession, AStrongerOneThatIsStartedLaterWaits) {
  Group group;
  group.add(1);
  group.run(5s);
  ASSERT_TRUE(group.active(0));
  group.add(0);
  group.run(5s);
  EXPECT_TRUE(group.active(0));
  EXPECT_FALSE(group.active(1));
}

TEST(Succession, TwoOfTheSamePlaceAgreeOnOne) {
  Group group;
  group.add(0);
  group.add(0);
  group.run(5s);
  EXPECT_EQ(group.active_count(), 1);
}

TEST(Succession, AfterANetworkWasCutOneOfTwoStays) {
  Group group;
  group.add(0);
  group.add(1, 11ms);
  group.run(5s);
  group.cut = true;
  group.run(1s);
  EXPECT_EQ(group.active_count(), 2) << "each side goes on";
  group.cut = false;
  group.run(2 * kPeriod);
  EXPECT_EQ(group.active_count(), 1);
  EXPECT_TRUE(group.active(1)) << "the one that took over later";
}

TEST(Succession, WhateverDiesAndComesBackOneLivingInstanceIsActiveSoon) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    Group group;
    for (int i = 0; i < 4; ++i) group.add(i % 3, std::chrono::milliseconds(random() % 20));
    group.run(4s);
    for (int event = 0; event < 20; ++event) {
      Group::Instance& instance = *group.all[random() % group.all.size()];
      instance.running = !instance.running;
      group.run(5 * kPeriod);
      bool any = false;
      for (const auto& each : group.all) any = any || each->running;
      EXPECT_EQ(group.active_count(), any ? 1 : 0) << "round " << round << ", event " << event;
    }
  }
}

}  // namespace
}  // namespace swiftlet
