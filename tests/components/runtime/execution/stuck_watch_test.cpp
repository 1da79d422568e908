// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/stuck_watch.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

TEST(StuckWatch, WhoIsInsideAtEveryQuestionIsStuck) {
  StuckWatch watch;
  std::promise<void> entered, leave;
  std::thread thread([&] {
    const StuckWatch::Inside inside("writing 'imu0'");
    entered.set_value();
    leave.get_future().wait();
  });
  entered.get_future().wait();
  for (int i = 1; i < 10; ++i) EXPECT_FALSE(watch.inside_since(10)) << i;
  EXPECT_EQ(watch.inside_since(10), "writing 'imu0'");
  leave.set_value();
  thread.join();
  EXPECT_FALSE(watch.inside_since(1));
}

TEST(StuckWatch, WhoGoesInAndOutIsNot) {
  StuckWatch watch;
  for (int i = 0; i < 100; ++i) {
    const StuckWatch::Inside inside("writing");
    EXPECT_FALSE(watch.inside_since(2));
  }
}

TEST(StuckWatch, NorWhoMovesInsideOfSomething) {
  StuckWatch watch;
  const StuckWatch::Inside outer("delivering");
  for (int i = 0; i < 100; ++i) {
    { const StuckWatch::Inside inner("writing"); }
    EXPECT_FALSE(watch.inside_since(2));
  }
  EXPECT_EQ(watch.inside_since(2), "delivering");
}

struct Stuck : Component {
  explicit Stuck(const ComponentContext& context) : Component(context) {
    every(1ms, [](Time) {
      const StuckWatch::Inside inside("writing 'imu0'");
      std::this_thread::sleep_for(60s);
    });
  }
};

TEST(StuckWatchDeathTest, AProcessWhoseMiddlewareIsStuckEndsAndSaysSo) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(
      {
        HostOptions options;
        options.participant.domain = 78;
        options.participant.isolated = true;
        Host host(options);
        host.emplace<Stuck>("stuck");
        host.run();
      },
      testing::ExitedWithCode(70), "stuck in writing 'imu0'");
}

}  // namespace
}  // namespace swiftlet
