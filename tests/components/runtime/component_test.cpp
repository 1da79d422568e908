// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Components on the lockstep executor and real Fast DDS.
#include "components/runtime/component.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "all_messages.hpp"
#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using rosgraph_msgs::msg::Clock;
using sensor_msgs::msg::LaserScan;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Topic<Clock> kTick{"tick", qos::sensor};
constexpr Topic<Clock> kTock{"tock", qos::command};
constexpr Topic<LaserScan> kLarge{"large", qos::map};

struct Ticker : Component {
  Ticker(const ComponentContext& context, int ticks) : Component(context) {
    tick_ = advertise(kTick);
    every(10ms, [this, ticks](Time now) {
      Clock message;
      message.clock().nanosec(static_cast<std::uint32_t>(now.time_since_epoch().count()));
      tick_.publish(message);
      if (++sent_ == ticks) stop(0);
    });
  }
  Publisher<Clock> tick_;
  int sent_ = 0;
};

/// Answers each tick within the same moment.
struct Echo : Component {
  explicit Echo(const ComponentContext& context) : Component(context) {
    tock_ = advertise(kTock);
    subscribe(kTick, [this](const Clock& tick) { tock_.publish(tick); });
  }
  Publisher<Clock> tock_;
};

struct Listener : Component {
  Listener(const ComponentContext& context, std::vector<std::string>& heard) : Component(context) {
    subscribe(kTock, [this, &heard](const Clock& tock) {
      heard.push_back(name() + "@" + std::to_string(now().time_since_epoch() / 1ms) + ":" +
                      std::to_string(tock.clock().nanosec() / 1000000));
    });
  }
};

HostOptions lockstep() {
  HostOptions options;
  options.lockstep = true;
  return options;
}

std::vector<std::string> run_once() {
  std::vector<std::string> heard;
  Host host(lockstep());
  host.emplace<Listener>("a", heard);
  host.emplace<Echo>("echo");
  host.emplace<Listener>("b", heard);
  host.emplace<Ticker>("ticker", 3);
  EXPECT_EQ(host.run(), 0);
  return heard;
}

TEST(Lockstep, ChainsOfMessagesAreFollowedBeforeTimeMovesOn) {
  EXPECT_THAT(run_once(), ElementsAre("a@10:10", "b@10:10", "a@20:20", "b@20:20"));
}

TEST(Lockstep, EveryRunIsTheSame) {
  const auto first = run_once();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(run_once(), first);
}

struct TimerOrder : Component {
  TimerOrder(const ComponentContext& context, std::vector<int>& order) : Component(context) {
    every(20ms, [&order](Time) { order.push_back(20); });
    every(10ms, [&order](Time) { order.push_back(10); });
    every(5ms, [this, &order](Time now) {
      order.push_back(5);
      if (now.time_since_epoch() == 20ms) stop(7);
    });
  }
};

TEST(Lockstep, TimersFireByTimeAndThenInTheOrderOfSettingUp) {
  std::vector<int> order;
  Host host(lockstep());
  host.emplace<TimerOrder>("timers", order);
  EXPECT_EQ(host.run(), 7);
  EXPECT_THAT(order, ElementsAre(5, 10, 5, 5, 20, 10, 5));
}

struct LargeSender : Component {
  explicit LargeSender(const ComponentContext& context) : Component(context) {
    large_ = advertise(kLarge);
    every(1s, [this](Time) {
      LaserScan scan;
      scan.ranges(std::vector<float>(1'250'000, 3.0f));  // 5 MB
      large_.publish(scan);
    });
  }
  Publisher<LaserScan> large_;
};

struct LargeReceiver : Component {
  LargeReceiver(const ComponentContext& context, std::size_t& size) : Component(context) {
    subscribe(kLarge, [this, &size](const LaserScan& scan) {
      size = scan.ranges().size();
      EXPECT_EQ(now(), Time(1s)) << "delivered at the moment of sending";
      stop(0);
    });
  }
};

TEST(Lockstep, LargeSamplesArriveWholeAndAtOnce) {
  std::size_t size = 0;
  Host host(lockstep());
  host.emplace<LargeReceiver>("receiver", size);
  host.emplace<LargeSender>("sender");
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(size, 1'250'000u);
}

struct Thrower : Component {
  explicit Thrower(const ComponentContext& context) : Component(context) {
    every(1ms, [](Time) { throw std::runtime_error("broken on purpose"); });
  }
};

TEST(Lockstep, AnExceptionEndsTheRunWithExitCode1) {
  Host host(lockstep());
  host.emplace<Thrower>("thrower");
  EXPECT_EQ(host.run(), 1);
}

TEST(Lockstep, ARunInWhichNothingCanHappenEnds) {
  Host host(lockstep());
  host.emplace<Echo>("echo");
  EXPECT_EQ(host.run(), 0);
}

TEST(HostAdd, AnUnknownComponentIsRefusedByName) {
  ComponentRegistry::instance().add(
      {"echo_for_test", "", [](const ComponentContext& context) -> std::unique_ptr<Component> {
         return std::make_unique<Echo>(context);
       }});
  Host host(lockstep());
  EXPECT_EQ(host.add("echo_for_test").name(), "echo_for_test");
  try {
    host.add("echo_for_tset");
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'echo_for_test'?"));
  }
}

}  // namespace
}  // namespace swiftlet
