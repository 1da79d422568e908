// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>

#include "components/runtime/execution/executor.hpp"
#include "components/runtime/execution/signals.hpp"
#include "components/runtime/execution/timers.hpp"
#include "components/runtime/log.hpp"

namespace swiftlet {
namespace {

class LockstepExecutor : public Executor {
 public:
  explicit LockstepExecutor(Time start) : now_(start) {}

  std::unique_ptr<Mailbox> make_mailbox(const std::string&) override {
    return std::make_unique<LockstepMailbox>(*this);
  }

  Time now() const override { return now_; }
  bool is_lockstep() const override { return true; }

  void stop(int exit_code) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!exit_code_) exit_code_ = exit_code;
  }

  void set_event_source(EventSource& source) override { source_ = &source; }

  int run() override {
    try {
      while (!finished()) {
        if (signals_.received()) return 0;
        if (Task* task = next_task()) {
          task->run();
        } else if (!run_next_event()) {
          return 0;  // nothing will ever happen again
        }
      }
    } catch (const std::exception& error) {
      logger("executor")->critical("stopped by an unexpected error: {}", error.what());
      return 1;
    }
    return *exit_code_;
  }

 private:
  class LockstepMailbox : public Mailbox {
   public:
    explicit LockstepMailbox(LockstepExecutor& executor) : executor_(executor) {}
    void post(Task& task) override {
      const std::lock_guard<std::mutex> lock(executor_.mutex_);
      if (!*halted_) executor_.tasks_.push_back({&task, halted_});
    }
    void every(Duration period, std::function<void(Time)> callback) override {
      executor_.timers_.every(executor_.now_ + period, period, unless_halted(std::move(callback)));
    }
    void call_at(Time time, std::function<void(Time)> callback) override {
      executor_.timers_.once(time, unless_halted(std::move(callback)));
    }
    void halt() override {
      const std::lock_guard<std::mutex> lock(executor_.mutex_);
      *halted_ = true;
    }

   private:
    std::function<void(Time)> unless_halted(std::function<void(Time)> callback) const {
      return [halted = halted_, callback = std::move(callback)](Time now) {
        if (!*halted) callback(now);
      };
    }

    LockstepExecutor& executor_;
    std::shared_ptr<bool> halted_ = std::make_shared<bool>(false);
  };

  struct PostedTask {
    Task* task;
    std::shared_ptr<const bool> halted;  // of its mailbox
  };

  bool finished() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return exit_code_.has_value();
  }

  Task* next_task() {
    const std::lock_guard<std::mutex> lock(mutex_);
    while (!tasks_.empty()) {
      const PostedTask posted = std::move(tasks_.front());
      tasks_.pop_front();
      if (!*posted.halted) return posted.task;
    }
    return nullptr;
  }

  bool run_next_event() {
    const std::optional<Time> event = source_ == nullptr ? std::nullopt : source_->next();
    if (event && (timers_.empty() || *event < timers_.next() ||
                  (*event == timers_.next() && source_->before_timers()))) {
      now_ = std::max(now_, *event);
      source_->happen();
      return true;
    }
    if (timers_.empty()) return false;
    now_ = std::max(now_, timers_.next());
    timers_.fire(now_, now_);
    return true;
  }

  const SignalGuard signals_;  // from here on, so that a signal before run() ends the run, too
  Time now_;
  Timers<Time> timers_;
  EventSource* source_ = nullptr;
  std::mutex mutex_;  // of what other threads may touch: the two below
  std::deque<PostedTask> tasks_;
  std::optional<int> exit_code_;
};

}  // namespace

std::unique_ptr<Executor> make_lockstep_executor(Time start) {
  return std::make_unique<LockstepExecutor>(start);
}

}  // namespace swiftlet
