// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/background_work.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <stdexcept>
#include <string>

#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

HostOptions options(bool lockstep) {
  HostOptions options;
  options.participant.domain = 78;
  options.participant.isolated = true;
  options.lockstep = lockstep;
  return options;
}

/// Opens when it is told to.
class Latch {
 public:
  void open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  bool wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, 20s, [this] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

/// Starts work that ends only when ten more callbacks have run.
struct Patient : Component {
  explicit Patient(const ComponentContext& context) : Component(context) {
    every(1ms, [this](Time) {
      EXPECT_FALSE(busy_.exchange(true)) << "callbacks of one component must not overlap";
      if (++callbacks_ == 1) {
        component_thread = std::this_thread::get_id();
        work_.start(
            [this] {
              work_thread = std::this_thread::get_id();
              return latch_.wait() ? std::string("ended") : std::string("callbacks stood still");
            },
            [this](const std::string& result) {
              EXPECT_FALSE(busy_) << "results come among the callbacks";
              done_thread = std::this_thread::get_id();
              outcome = result;
              stop(0);
            });
        EXPECT_FALSE(work_.idle());
      }
      if (callbacks_ == 11) latch_.open();
      busy_ = false;
    });
  }
  std::string outcome;
  std::thread::id component_thread, work_thread, done_thread;

 private:
  std::atomic<bool> busy_{false};
  int callbacks_ = 0;
  Latch latch_;
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, CallbacksGoOnAndTheResultComesAmongThem) {
  Host host(options(false));
  auto& patient = host.emplace<Patient>("patient");
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(patient.outcome, "ended");
  EXPECT_EQ(patient.done_thread, patient.component_thread);
  EXPECT_NE(patient.work_thread, patient.component_thread);
}

/// Squares numbers in the background, one after the other, and notes when each result came.
struct Squarer : Component {
  explicit Squarer(const ComponentContext& context) : Component(context) {
    every(10ms, [this](Time) {
      EXPECT_TRUE(work_.idle());
      const int n = ++started_;
      work_.start([n] { return n * n; },
                  [this](int square) {
                    results.emplace_back(now(), square);
                    if (results.size() == 5) stop(0);
                  });
    });
  }
  std::vector<std::pair<Time, int>> results;

 private:
  int started_ = 0;
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, InLockstepResultsComeAtTheSameTimeInEveryRun) {
  Host host(options(true));
  auto& squarer = host.emplace<Squarer>("squarer");
  EXPECT_EQ(host.run(), 0);
  ASSERT_EQ(squarer.results.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const auto& [time, square] = squarer.results[static_cast<std::size_t>(i)];
    EXPECT_EQ(time.time_since_epoch(), (i + 1) * 10ms);
    EXPECT_EQ(square, (i + 1) * (i + 1));
  }
}

/// Work leaves something in its thread that lasts until its result has been taken in.
struct Lingering : Component {
  explicit Lingering(const ComponentContext& context) : Component(context) {
    every(1ms, [this](Time) {
      if (started_) return;
      started_ = true;
      auto handed_over = std::make_shared<int>(1);
      handed_over_ = handed_over;
      work_.start(
          [this, handed_over = std::move(handed_over)] {
            static thread_local AtThreadEnd lingers;
            lingers.wait_for = &taken_in_;
            return *handed_over;
          },
          [this](int) {
            given_back = handed_over_.expired();
            taken_in_.open();
            stop(0);
          });
    });
  }
  static inline bool waited_in_vain = false;
  bool given_back = false;

 private:
  struct AtThreadEnd {
    Latch* wait_for = nullptr;
    ~AtThreadEnd() { waited_in_vain = !wait_for->wait(); }
  };
  bool started_ = false;
  std::weak_ptr<int> handed_over_;
  Latch taken_in_;
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, ResultsWaitForWhatWasHandedOverButNotForTheThread) {
  Host host(options(false));
  auto& lingering = host.emplace<Lingering>("lingering");
  EXPECT_EQ(host.run(), 0);
  EXPECT_TRUE(lingering.given_back);
  EXPECT_FALSE(Lingering::waited_in_vain) << "a callback joined the thread";
}

/// Processor time of a thread.
std::chrono::nanoseconds computed(pthread_t thread) {
  clockid_t clock{};
  timespec time{};
  if (pthread_getcpuclockid(thread, &clock) != 0 || clock_gettime(clock, &time) != 0) {
    throw std::runtime_error("no clock of the thread's processor time");
  }
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// A callback and work in the background that compute on one processor.
struct Rivals : Component {
  explicit Rivals(const ComponentContext& context) : Component(context) {
    every(1ms, [this](Time) {
      if (callback != 0ms || !work_.idle()) return;
      const int processor = sched_getcpu();
      work_.start(
          [this, processor] {
            stay_on(processor);
            work_thread_ = pthread_self();
            begun_.open();
            while (!ended_) continue;
            return 0;
          },
          [this](int) { stop(0); });
      stay_on(processor);
      if (!begun_.wait()) {
        ended_ = true;
        return stop(1);
      }
      const auto begin = computed(pthread_self()), begin_of_work = computed(work_thread_);
      while (computed(pthread_self()) < begin + 500ms) continue;
      callback = computed(pthread_self()) - begin;
      work = computed(work_thread_) - begin_of_work;
      ended_ = true;
    });
  }
  std::chrono::nanoseconds callback{0}, work{0};

 private:
  static void stay_on(int processor) {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    CPU_SET(processor, &processors);
    ASSERT_EQ(sched_setaffinity(0, sizeof(processors), &processors), 0);
  }
  pthread_t work_thread_{};
  std::atomic<bool> ended_{false};
  Latch begun_;
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, CallbacksComeFirstOnAProcessorThatBothWant) {
  Host host(options(false));
  auto& rivals = host.emplace<Rivals>("rivals");
  EXPECT_EQ(host.run(), 0);
  EXPECT_GE(rivals.callback.count(), 500'000'000);
  EXPECT_GT(rivals.work.count(), 0) << "it must not starve";
  EXPECT_LT(rivals.work.count(), rivals.callback.count() / 3);
}

struct Breaking : Component {
  explicit Breaking(const ComponentContext& context) : Component(context) {
    every(1ms, [this](Time) {
      if (!work_.idle()) return;
      work_.start([]() -> int { throw std::runtime_error("broken on purpose"); },
                  [](int) { FAIL() << "there is no result"; });
    });
  }

 private:
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, ItsExceptionsAreTheComponents) {
  for (const bool lockstep : {false, true}) {
    Host host(options(lockstep));
    host.emplace<Breaking>("breaking");
    EXPECT_EQ(host.run(), 1);
  }
}

struct Leaving : Component {
  explicit Leaving(const ComponentContext& context, std::atomic<int>& ended) : Component(context) {
    every(1ms, [this, &ended](Time) {
      if (!work_.idle()) return;
      work_.start(
          [&ended] {
            std::this_thread::sleep_for(100ms);  // outlasts the run
            return ++ended;
          },
          [](int) {});
      stop(0);
    });
  }

 private:
  BackgroundWork work_{mailbox(), *context().executor};
};

TEST(BackgroundWork, AComponentThatGoesWaitsForItsWork) {
  std::atomic<int> ended{0};
  {
    Host host(options(false));
    host.emplace<Leaving>("leaving", ended);
    EXPECT_EQ(host.run(), 0);
  }
  EXPECT_EQ(ended, 1);
}

}  // namespace
}  // namespace swiftlet
