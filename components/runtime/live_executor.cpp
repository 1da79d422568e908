// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "components/runtime/executor.hpp"
#include "components/runtime/log.hpp"
#include "components/runtime/signals.hpp"
#include "components/runtime/timers.hpp"

namespace swiftlet {
namespace {

using Steady = std::chrono::steady_clock;

/// Time of day at the start of the process, moved on by the steady clock: comparable between hosts
/// and never set back while it runs.
Time time_at(Steady::time_point steady) {
  static const Steady::time_point steady_start = Steady::now();
  static const Time start{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())};
  return start + std::chrono::duration_cast<Duration>(steady - steady_start);
}

class LiveExecutor : public Executor {
 public:
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
    {
      std::unique_lock<std::mutex> lock(mutex_);
      // A signal handler cannot notify, so look for one now and then.
      while (!exit_code_ && !signals_.received()) {
        changed_.wait_for(lock, std::chrono::milliseconds(20));
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
      thread_ = std::thread([this] {
        try {
          serve();
        } catch (const std::exception& error) {
          logger(component_)->critical("stopped by an unexpected error: {}", error.what());
          executor_.stop(1);
        }
      });
    }

    void finish() {
      halt();
      if (thread_.joinable()) thread_.join();
    }

   private:
    void serve() {
      std::unique_lock<std::mutex> lock(mutex_);
      while (!finished_) {
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
          changed_.wait_until(lock, timers_.next());
        } else {
          changed_.wait(lock);
        }
      }
    }

    LiveExecutor& executor_;
    std::string component_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Task*> tasks_;
    bool finished_ = false;
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
