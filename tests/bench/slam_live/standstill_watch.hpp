// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace swiftlet {

/// Notes when a processor served nobody at all: on each a thread of the highest real-time priority
/// wakes 2000 times a second, and where it comes late no other thread can have held it up. On a
/// virtual machine the host has taken that processor away; the kernel itself seldom takes so long.
class StandstillWatch {
 public:
  using Clock = std::chrono::steady_clock;
  using Span = std::pair<Clock::time_point, Clock::time_point>;

  StandstillWatch();
  ~StandstillWatch() { finish(); }
  StandstillWatch(const StandstillWatch&) = delete;
  StandstillWatch& operator=(const StandstillWatch&) = delete;

  /// Stops watching. True when every thread had what it asks for: a processor and a priority.
  bool finish();
  /// How long, of that span, one processor or more stood still [ms]. After finish().
  double within(const Span& span) const;
  const std::vector<Span>& spans() const { return spans_; }

 private:
  void watch(unsigned processor);

  std::atomic<bool> ends_{false}, refused_{false};
  std::mutex mutex_;
  std::vector<Span> spans_;  // after finish() in order, and none touches another
  std::vector<std::thread> threads_;
};

}  // namespace swiftlet
