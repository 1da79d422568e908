// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Something that can be done for a component when its turn comes, again and again: dispatching
/// one sample of a subscription, for instance. It outlives its mailbox's use of it.
class Task {
 public:
  virtual ~Task() = default;
  virtual void run() = 0;
};

/// What waits to be done for one component. Tasks and timers of one mailbox never run at the same
/// time, those of different mailboxes may.
class Mailbox {
 public:
  virtual ~Mailbox() = default;
  /// Notes that `task` shall run once more. From any thread; returns at once.
  virtual void post(Task& task) = 0;
  /// The same for a task that is short: it may run before this returns, in the calling thread,
  /// where nothing else of this mailbox runs or waits.
  virtual void run_or_post(Task& task) { post(task); }
  /// Calls `callback` every `period`, first one period after the run began, with the time at which
  /// it runs. Periods that were missed are not made up for. Only before the run begins.
  virtual void every(Duration period, std::function<void(Time now)> callback) = 0;
  /// Calls `callback` once at `time`, or at once where that has passed. Before the run begins, or
  /// from a callback of this mailbox.
  virtual void call_at(Time time, std::function<void(Time now)> callback) = 0;
  /// No task and no timer of this mailbox runs any more, once the present one has ended.
  virtual void halt() = 0;
};

/// What happens at times of its own in a lockstep run, besides timers: recorded messages.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// When it happens next; nothing when it is over.
  virtual std::optional<Time> next() const = 0;
  /// Whether, of all that is due at that moment, it comes before the timers.
  virtual bool before_timers() const = 0;
  virtual void happen() = 0;
};

/// Runs components, in one of two ways that components cannot tell apart.
class Executor {
 public:
  virtual ~Executor() = default;

  virtual std::unique_ptr<Mailbox> make_mailbox(const std::string& component) = 0;
  /// The time of the clock that drives this run.
  virtual Time now() const = 0;
  /// Whether that is a clock of discrete events, so that the same inputs give the same run.
  virtual bool is_lockstep() const = 0;
  /// Runs until stop() or SIGINT or SIGTERM. Returns the exit code: that of stop(), 0 for a
  /// signal, and 1 where a component threw an exception (which is logged).
  virtual int run() = 0;
  /// From any thread. The first call decides.
  virtual void stop(int exit_code) = 0;
  /// One source of events, which must outlive the run. In lockstep only, before the run begins;
  /// throws std::logic_error otherwise.
  virtual void set_event_source(EventSource& source) = 0;
};

/// A thread for each component and the system's clock, in nanoseconds since 1970 that never jump.
std::unique_ptr<Executor> make_live_executor();

/// One thread and a clock that moves on to the next timer only when every mailbox is empty: the
/// same inputs give the same run, as fast as the processor allows. Needs an isolated participant.
/// Mailboxes are served in the order in which their tasks were posted, timers that are due at the
/// same moment in the order in which they were set up.
std::unique_ptr<Executor> make_lockstep_executor(Time start = Time{});

}  // namespace swiftlet
