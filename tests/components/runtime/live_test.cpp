// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Components on the live executor: threads and the system's clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>
#include <utility>

#include "all_messages.hpp"
#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using rosgraph_msgs::msg::Clock;

constexpr Topic<Clock> kPing{"ping", qos::command};
constexpr Topic<Clock> kPong{"pong", qos::command};

HostOptions live(const std::string& vehicle) {
  HostOptions options;
  options.participant.domain = 78;
  options.participant.isolated = true;
  options.vehicle = vehicle;
  return options;
}

struct Pinger : Component {
  Pinger(const ComponentContext& context, int rounds) : Component(context) {
    ping_ = advertise(kPing);
    subscribe(kPong, [this, rounds](const Clock&) {
      EXPECT_FALSE(busy_.exchange(true)) << "callbacks of one component must not overlap";
      if (++rounds_ == rounds) stop(0);
      busy_ = false;
    });
    every(1ms, [this](Time now) {
      EXPECT_FALSE(busy_.exchange(true));
      EXPECT_GT(now, last_);
      last_ = now;
      ping_.publish(Clock());
      busy_ = false;
    });
  }
  Publisher<Clock> ping_;
  std::atomic<bool> busy_{false};
  Time last_{};
  int rounds_ = 0;
};

struct Ponger : Component {
  explicit Ponger(const ComponentContext& context) : Component(context) {
    pong_ = advertise(kPong);
    subscribe(kPing, [this](const Clock& ping) { pong_.publish(ping); });
  }
  Publisher<Clock> pong_;
};

TEST(Live, ComponentsTalkAcrossThreadsWithoutOverlap) {
  Host host(live("v"));
  host.emplace<Pinger>("pinger", 200);
  host.emplace<Ponger>("ponger");
  EXPECT_EQ(host.run(), 0);
}

TEST(Live, TwoVehiclesInOneDomainDoNotHearEachOther) {
  Host host(live("a"));
  host.emplace<Pinger>("pinger", 1);
  Host other(live("b"));
  other.emplace<Ponger>("ponger");
  std::thread stopper([&] {
    std::this_thread::sleep_for(300ms);
    host.executor().stop(5);
  });
  EXPECT_EQ(host.run(), 5) << "a pong of the other vehicle would have stopped it with 0";
  stopper.join();
}

struct Stopper : Component {
  explicit Stopper(const ComponentContext& context) : Component(context) {
    every(20ms, [this](Time) {
      if (!std::exchange(raised_, true)) std::raise(SIGTERM);
    });
  }
  bool raised_ = false;
};

TEST(Live, SigtermEndsTheRunCleanly) {
  Host host(live("v"));
  host.emplace<Stopper>("stopper");
  host.emplace<Ponger>("ponger");
  EXPECT_EQ(host.run(), 0);
}

struct Thrower : Component {
  explicit Thrower(const ComponentContext& context) : Component(context) {
    every(1ms, [](Time) { throw std::runtime_error("broken on purpose"); });
  }
};

TEST(Live, AnExceptionEndsTheRunWithExitCode1) {
  Host host(live("v"));
  host.emplace<Thrower>("thrower");
  EXPECT_EQ(host.run(), 1);
}

}  // namespace
}  // namespace swiftlet
