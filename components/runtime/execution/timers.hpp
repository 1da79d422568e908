// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Timers in the order in which they are due; those due at the same moment in the order in which
/// they were set up. Time is any clock's.
template <class TimePoint>
class Timers {
 public:
  using Callback = std::function<void(Time now)>;

  void every(TimePoint first, Duration period, Callback callback) {
    timers_.emplace(Key{first, next_order_++}, Timer{period, std::move(callback)});
  }
  void once(TimePoint due, Callback callback) {
    timers_.emplace(Key{due, next_order_++}, Timer{Duration(0), std::move(callback)});
  }

  bool empty() const { return timers_.empty(); }
  /// Only where it is not empty.
  TimePoint next() const { return timers_.begin()->first.first; }

  /// Runs the first timer as of `now`; a periodic one is due again at the first multiple of its
  /// period after `clock_now`. The callback may add timers.
  void fire(TimePoint clock_now, Time now) {
    auto timer = timers_.extract(timers_.begin());
    timer.mapped().callback(now);
    const Duration period = timer.mapped().period;
    if (period == Duration(0)) return;
    TimePoint& due = timer.key().first;
    const auto behind = std::chrono::duration_cast<Duration>(clock_now - due);
    due += std::chrono::duration_cast<typename TimePoint::duration>(period * (behind / period + 1));
    timers_.insert(std::move(timer));
  }

 private:
  using Key = std::pair<TimePoint, std::uint64_t>;
  struct Timer {
    Duration period;  // zero: once
    Callback callback;
  };
  std::map<Key, Timer> timers_;
  std::uint64_t next_order_ = 0;
};

}  // namespace swiftlet
