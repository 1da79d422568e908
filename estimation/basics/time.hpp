// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace swiftlet {

/// Lengths of time, in nanoseconds.
using Duration = std::chrono::nanoseconds;

/// The clock that drives a run: simulated in lockstep, the system's in live operation. It has no
/// `now()`: algorithms are given the time, they never ask for it.
struct RunClock {
  using duration = Duration;
  using rep = Duration::rep;
  using period = Duration::period;
  using time_point = std::chrono::time_point<RunClock, Duration>;
  static constexpr bool is_steady = true;
};

/// A moment of the run.
using Time = RunClock::time_point;

/// Seconds as a floating-point number, for mathematics.
constexpr double to_seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
constexpr double to_seconds(Time time) {
  return to_seconds(time.time_since_epoch());
}

/// The nearest whole number of nanoseconds. `seconds` must be finite and below 292 years.
constexpr Duration from_seconds(double seconds) {
  return Duration(static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5)));
}

}  // namespace swiftlet
