// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "components/runtime/execution/executor.hpp"
#include "components/runtime/execution/real_time.hpp"
#include "components/runtime/execution/signals.hpp"
#include "components/runtime/execution/stuck_watch.hpp"
#include "components/runtime/execution/timers.hpp"
#include "components/runtime/log.hpp"

namespace swiftlet {
namespace {

using Steady = std::chrono::steady_clock;

/// One moment on both clocks.
struct ClockPair {
  Steady::time_point steady;
  Time system{};
};

/// Of several readings the one that took the shortest time: a thread that loses the processor
/// between the two clocks would be off by that long for the whole run.
ClockPair read_both_clocks() {
  ClockPair best;
  Steady::duration shortest = Steady::duration::max();
  for (int i = 0; i < 20; ++i) {
    const Steady::time_point before = Steady::now();
    const auto system = std::chrono::system_clock::now().time_since_epoch();
    const Steady::duration took = Steady::now() - before;
    if (took >= shortest) continue;
    shortest = took;
    best = {before + took / 2, Time(std::chrono::duration_cast<Duration>(system))};
  }
  return best;
}

/// Time of day at the start of the process, moved on by the steady clock: comparable between hosts
/// and never set back while it runs.
Time time_at(Steady::time_point steady) {
  static const ClockPair start = read_both_clocks();
  return start.system + std::chrono::duration_cast<Duration>(steady - start.steady);
}

/// The right to run a task in a thread of the middleware. Such a thread holds the lock of a reader
/// while it delivers; two of them that ran callbacks, each publishing to the other's reader, would
/// wait for each other for ever. So one thread of the process has this right at a time, and none
/// twice.
class AtOnceRight {
 public:
  AtOnceRight() : granted_(!taken_.exchange(true, std::memory_order_acquire)) {}
  ~AtOnceRight() {
    if (granted_) taken_.store(false, std::memory_order_release);
  }
  AtOnceRight(const AtOnceRight&) = delete;
  AtOnceRight& operator=(const AtOnceRight&) = delete;
  explicit operator bool() const { return granted_; }

 private:
  static inline std::atomic<bool> taken_{false};
  bool granted_;
};

/// How often the main thread looks around, and how often it sees a thread in the same call until
/// that call is taken for one that never ends: five seconds. Calls block for a tenth of one at
/// most.
constexpr auto kLook = std::chrono::milliseconds(20);
constexpr int kLooksUntilStuck = 250;
constexpr int kStuckExitCode = 70;  // EX_SOFTWARE

/// Nothing is put in order: what would be is what does not come back.
[[noreturn]] void end_stuck(const std::string& what) {
  const Logger log = logger("executor");
  log->critical("stuck in {} for good: this process ends, so that another can take its place",
                what);
  log->flush();
  std::_Exit(kStuckExitCode);
}

/// A callback that holds up the middleware for longer than that is named in the log.
constexpr auto kShort = std::chrono::milliseconds(1);

class LiveExecutor : public Executor {
 public:
  LiveExecutor() { keep_memory(); }

  std::unique_ptr<Mailbox> make_mailbox(const std::string& component) override {
    auto mailbox = std::make_unique<LiveMailbox>(*this, component);
    mailboxes_.push_back(mailbox.get());
    return mailbox;
  }

  Time now() const override { return time_at(Steady::now()); }
  bool is_lockstep() const override { return false; }

  void stop(int exit_code) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!exit_code_) exit_code_ = exit_code;
    changed_.notify_all();
  }

  void set_event_source(EventSource&) override {
    throw std::logic_error("events of recorded times need a lockstep run");
  }

  int run() override {
    for (LiveMailbox* mailbox : mailboxes_) mailbox->start();
    int exit_code = 0;
    StuckWatch stuck_watch;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      // A signal handler cannot notify, so look for one now and then.
      while (!exit_code_ && !signals_.received()) {
        changed_.wait_for(lock, kLook);
        if (const auto what = stuck_watch.inside_since(kLooksUntilStuck)) end_stuck(*what);
      }
      exit_code = exit_code_.value_or(0);
    }
    for (LiveMailbox* mailbox : mailboxes_) mailbox->finish();
    return exit_code;
  }

 private:
  class LiveMailbox : public Mailbox {
   public:
    LiveMailbox(LiveExecutor& executor, std::string component)
        : executor_(executor), component_(std::move(component)) {}

    ~LiveMailbox() override {
      finish();
      auto& all = executor_.mailboxes_;
      all.erase(std::remove(all.begin(), all.end(), this), all.end());
    }

    void post(Task& task) override {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        tasks_.push_back(&task);
      }
      changed_.notify_one();
    }

    void run_or_post(Task& task) override {
      if (!run_at_once(task)) post(task);
    }

    void every(Duration period, std::function<void(Time)> callback) override {
      timers_.every(Steady::now() + period, period, std::move(callback));
    }

    void call_at(Time time, std::function<void(Time)> callback) override {
      const Steady::time_point steady = Steady::now();
      timers_.once(steady + (time - time_at(steady)), std::move(callback));
    }

    void halt() override {
      const std::lock_guard<std::mutex> lock(mutex_);
      finished_ = true;
      changed_.notify_one();
    }

    void start() {
      thread_ = std::thread([this] { guarded([this] { serve(); }); });
    }

    void finish() {
      halt();
      if (thread_.joinable()) thread_.join();
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return !runs_at_once_; });
    }

   private:
    template <class Function>
    void guarded(Function function) {
      try {
        function();
      } catch (const std::exception& error) {
        logger(component_)->critical("stopped by an unexpected error: {}", error.what());
        executor_.stop(1);
      }
    }

    /// False, without having run it, where something else of this mailbox runs or waits.
    bool run_at_once(Task& task) {
      const AtOnceRight right;
      if (!right) return false;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!waits_ || finished_ || !tasks_.empty()) return false;
        runs_at_once_ = true;
      }
      const bool had_timers = !timers_.empty();
      const Steady::time_point first_timer = had_timers ? timers_.next() : Steady::time_point();
      const Steady::time_point begin = Steady::now();
      guarded([&task] { task.run(); });
      if (Steady::now() - begin > kShort) note_long();
      const std::lock_guard<std::mutex> lock(mutex_);
      runs_at_once_ = false;
      // Only where the thread has something to do: to wake it is what this is there to save. Within
      // the lock, since finish() may be waiting, and then nothing of this is left.
      const bool has_earlier_timer =
          !timers_.empty() && (!had_timers || timers_.next() < first_timer);
      if (held_up_ || finished_ || !tasks_.empty() || has_earlier_timer) changed_.notify_all();
      held_up_ = false;
      return true;
    }

    void note_long() {
      const std::uint64_t count = ++long_runs_;
      if (!is_worth_a_line(count)) return;
      logger(component_)
          ->warn(
              "callbacks that run at once held up the middleware for more than {} ms, {} so far: "
              "subscribe without at_once",
              kShort.count(), count);
    }

    /// Waits in the way of `wait`, and lets tasks run at once meanwhile.
    template <class Wait>
    void wait_idle(Wait wait) {
      waits_ = true;
      wait();
      waits_ = false;
    }

    void serve() {
      std::unique_lock<std::mutex> lock(mutex_);
      while (!finished_) {
        if (runs_at_once_) {  // and may change the timers
          held_up_ = true;
          changed_.wait(lock);
          continue;
        }
        const bool timer_is_due = !timers_.empty() && timers_.next() <= Steady::now();
        if (timer_is_due) {
          lock.unlock();
          const Steady::time_point now = Steady::now();
          timers_.fire(now, time_at(now));
          lock.lock();
        } else if (!tasks_.empty()) {
          Task* task = tasks_.front();
          tasks_.pop_front();
          lock.unlock();
          task->run();
          lock.lock();
        } else if (!timers_.empty()) {
          const Steady::time_point next = timers_.next();  // by value: it may change meanwhile
          wait_idle([&] { changed_.wait_until(lock, next); });
        } else {
          wait_idle([&] { changed_.wait(lock); });
        }
      }
    }

    LiveExecutor& executor_;
    std::string component_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Task*> tasks_;
    bool finished_ = false;
    bool waits_ = false;         // the thread has nothing to do
    bool runs_at_once_ = false;  // a task runs in another thread
    bool held_up_ = false;       // the thread has something to do, and waits for that one's end
    std::uint64_t long_runs_ = 0;
    Timers<Steady::time_point> timers_;
    std::thread thread_;
  };

  const SignalGuard signals_;  // from here on, so that a signal before run() ends the run, too
  std::vector<LiveMailbox*> mailboxes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<int> exit_code_;
};

}  // namespace

std::unique_ptr<Executor> make_live_executor() {
  return std::make_unique<LiveExecutor>();
}

}  // namespace swiftlet
