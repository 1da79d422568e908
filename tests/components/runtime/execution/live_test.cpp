// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Components on the live executor: threads and the system's clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

/// As kPing and kPong, deep enough for a thread that gets no processor for a while.
constexpr QosProfile kDeep{"command", true, false, 8192, false};
constexpr Topic<Clock> kSoon{"soon", kDeep};
constexpr Topic<Clock> kLater{"later", kDeep};

/// Notes in which threads its callbacks run, and that they do not overlap. Ends the run when it has
/// heard so many messages of both topics.
struct Hearer : Component {
  Hearer(const ComponentContext& context, int messages, bool with_timer)
      : Component(context), messages_(messages) {
    subscribe(at_once(kSoon), [this](const Clock&) { note(heard_at_once, threads_at_once); });
    subscribe(kLater, [this](const Clock&) { note(heard_posted, threads_posted); });
    if (with_timer) {
      int unused = 0;
      every(1ms, [this, unused](Time) mutable { note(unused, threads_posted); });
    }
  }
  void note(int& count, std::set<std::thread::id>& threads) {
    EXPECT_FALSE(busy_.exchange(true)) << "callbacks of one component must not overlap";
    threads.insert(std::this_thread::get_id());
    ++count;
    if (heard_at_once == messages_ && heard_posted == messages_) stop(0);
    busy_ = false;
  }
  int heard_at_once = 0;
  int heard_posted = 0;
  std::set<std::thread::id> threads_at_once;
  std::set<std::thread::id> threads_posted;

 private:
  int messages_;
  std::atomic<bool> busy_{false};
};

/// Publishes both topics by turns, each a number of times, and notes its thread.
struct Talker : Component {
  Talker(const ComponentContext& context, int messages) : Component(context) {
    soon_ = advertise(kSoon);
    later_ = advertise(kLater);
    every(500us, [this, messages](Time) {
      thread = std::this_thread::get_id();
      if (sent == messages) {
        // Ten seconds for what is still to be heard.
        if (++after_ == 20000) stop(3);
        return;
      }
      ++sent;
      soon_.publish(Clock());
      later_.publish(Clock());
    });
  }
  int sent = 0;
  std::thread::id thread;

 private:
  int after_ = 0;
  Publisher<Clock> soon_;
  Publisher<Clock> later_;
};

TEST(Live, AtOnceMeansInTheThreadThatDelivers) {
  Host host(live("v"));
  const Hearer& hearer = host.emplace<Hearer>("hearer", 200, false);
  const Talker& talker = host.emplace<Talker>("talker", 200);
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(hearer.heard_at_once, 200);
  EXPECT_EQ(hearer.heard_posted, 200);
  EXPECT_EQ(hearer.threads_at_once.count(talker.thread), 1u);
  EXPECT_EQ(hearer.threads_posted.count(talker.thread), 0u);
}

TEST(Live, AtOnceCallbacksDoNotOverlapWithOthersNorLoseAny) {
  Host host(live("v"));
  const Hearer& hearer = host.emplace<Hearer>("hearer", 2000, true);
  host.emplace<Talker>("one", 1000);
  host.emplace<Talker>("two", 1000);
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(hearer.heard_at_once, 2000);
  EXPECT_EQ(hearer.heard_posted, 2000);
}

/// Publishes to its twin from a timer, and answers it at once.
struct Twin : Component {
  Twin(const ComponentContext& context, const Topic<Clock>& out, const Topic<Clock>& in, int rounds)
      : Component(context) {
    out_ = advertise(out);
    subscribe(at_once(in), [this, rounds](const Clock& message) {
      // An answer is not answered.
      if (message.clock().sec() == 0) {
        Clock answer;
        answer.clock().sec(1);
        out_.publish(answer);
      } else if (++answers == rounds) {
        stop(0);
      }
    });
    every(50us, [this](Time) { out_.publish(Clock()); });
  }
  int answers = 0;

 private:
  Publisher<Clock> out_;
};

TEST(Live, TwoThatAnswerEachOtherAtOnceDoNotWaitForEachOther) {
  Host host(live("v"));
  host.emplace<Twin>("one", kPing, kPong, 3000);
  host.emplace<Twin>("two", kPong, kPing, 3000);
  EXPECT_EQ(host.run(), 0);
}

/// Sets a timer in a callback that runs at once, with a thread that sleeps without end.
struct Sleeper : Component {
  explicit Sleeper(const ComponentContext& context) : Component(context) {
    subscribe(at_once(kSoon), [this](const Clock&) {
      if (!std::exchange(set_, true)) call_at(now() + 1ms, [this](Time) { stop(7); });
    });
  }
  bool set_ = false;
};

TEST(Live, ATimerThatIsSetAtOnceWakesTheThread) {
  Host host(live("v"));
  host.emplace<Sleeper>("sleeper");
  host.emplace<Talker>("talker", 1);
  EXPECT_EQ(host.run(), 7) << "3: the talker had to end it";
}

struct ThrowerAtOnce : Component {
  explicit ThrowerAtOnce(const ComponentContext& context) : Component(context) {
    subscribe(at_once(kSoon), [](const Clock&) { throw std::runtime_error("broken on purpose"); });
  }
};

TEST(Live, AnExceptionAtOnceEndsTheRunWithExitCode1) {
  Host host(live("v"));
  host.emplace<ThrowerAtOnce>("thrower");
  host.emplace<Talker>("talker", 10);
  EXPECT_EQ(host.run(), 1);
}

/// Uses a lot of memory in each callback and gives it back.
struct Spender : Component {
  explicit Spender(const ComponentContext& context) : Component(context) {
    every(1ms, [this](Time) {
      const long before = page_faults();
      for (int i = 0; i < 4; ++i) blocks_.emplace_back(kBlock, 'x');
      blocks_.clear();
      faults.push_back(page_faults() - before);
      if (faults.size() == 5) stop(0);
    });
  }
  static constexpr std::size_t kBlock = 4 << 20;
  std::vector<long> faults;  // of each callback

 private:
  static long page_faults() {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_minflt;
  }
  std::vector<std::string> blocks_;
};

TEST(Live, MemoryIsTouchedAnewOnlyOnce) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer's allocator is another";
#endif
  Host host(live("v"));
  const auto& spender = host.emplace<Spender>("spender");
  ASSERT_EQ(host.run(), 0);
  EXPECT_GE(spender.faults.front(), 4) << "it was new once";
  EXPECT_LT(spender.faults.back(), 16) << "of " << 4 * Spender::kBlock / 4096 << " pages";
}

}  // namespace
}  // namespace swiftlet
