// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "components/runtime/execution/executor.hpp"

namespace swiftlet {

/// Work that takes longer than a callback may: it is done in a thread of its own, while callbacks
/// go on, and its result is taken in when the component's turn comes. In lockstep it is done at
/// once, so that the same inputs give the same run.
///
///     BackgroundWork optimizer_{mailbox(), *context().executor};
///     ...
///     if (optimizer_.idle()) optimizer_.start([job] { return optimize(job); },
///                                             [this](Poses poses) { apply(poses); });
///
/// What the work needs is handed to it by value; nothing else is safe there. Callbacks come first
/// where both want the same processor: the work has ordinary scheduling in a real-time process,
/// too, and is nice (10) in any. No callback waits for its thread to end: a result is posted when
/// all that the work had is given back. The work's exceptions are the component's.
class BackgroundWork : private Task {
 public:
  BackgroundWork(Mailbox& mailbox, const Executor& executor)
      : mailbox_(mailbox), at_once_(executor.is_lockstep()) {}
  /// Waits for the work to end.
  ~BackgroundWork() override;
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

  /// No work is being done, and no result waits to be taken in.
  bool idle() const { return finish_ == nullptr; }

  /// Does `work()`, then `done(result)` among the component's callbacks. From one of these, and
  /// only when idle.
  template <class Work, class Done>
  void start(Work work, Done done) {
    using Outcome = decltype(work());
    auto outcome = std::make_shared<std::unique_ptr<Outcome>>();
    begin([outcome, work = std::move(work)] { *outcome = std::make_unique<Outcome>(work()); },
          [outcome, done = std::move(done)] { done(std::move(**outcome)); });
  }

 private:
  void begin(std::function<void()> work, std::function<void()> finish);
  void run() override;
  void serve();
  void perform(std::function<void()> work);

  Mailbox& mailbox_;
  bool at_once_;
  std::function<void()> finish_;
  std::exception_ptr error_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> next_;
  bool ends_ = false;
  std::thread thread_;  // from the first work on
};

}  // namespace swiftlet
