// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/slam_live/standstill_watch.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 500us;
constexpr auto kLate = 500us;  // more is no longer the way that a thread wakes

}  // namespace

StandstillWatch::StandstillWatch() {
  for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) {
    threads_.emplace_back([this, i] { watch(i); });
  }
}

void StandstillWatch::watch(unsigned processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  sched_param priority{};
  priority.sched_priority = sched_get_priority_max(SCHED_FIFO);
  if (pthread_setaffinity_np(pthread_self(), sizeof set, &set) != 0 ||
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) != 0) {
    refused_ = true;
    return;
  }
  Clock::time_point due = Clock::now() + kPeriod;
  while (!ends_) {
    std::this_thread::sleep_until(due);
    const Clock::time_point now = Clock::now();
    if (now - due > kLate) {
      const std::lock_guard<std::mutex> lock(mutex_);
      spans_.emplace_back(due, now);
    }
    due = now + kPeriod;
  }
}

bool StandstillWatch::finish() {
  ends_ = true;
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  std::sort(spans_.begin(), spans_.end());
  std::vector<Span> joined;
  for (const Span& span : spans_) {
    if (joined.empty() || joined.back().second < span.first) {
      joined.push_back(span);
    } else {
      joined.back().second = std::max(joined.back().second, span.second);
    }
  }
  spans_ = std::move(joined);
  return !refused_;
}

double StandstillWatch::within(const Span& span) const {
  Clock::duration sum{};
  for (const Span& still : spans_) {
    const auto overlap = std::min(still.second, span.second) - std::max(still.first, span.first);
    sum += std::max(overlap, Clock::duration::zero());
  }
  return std::chrono::duration<double, std::milli>(sum).count();
}

}  // namespace swiftlet
