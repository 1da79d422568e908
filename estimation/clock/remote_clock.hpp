// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "estimation/basics/time.hpp"
#include "estimation/clock/lower_envelope.hpp"

namespace swiftlet {

/// When, on our clock, something happened that a remote clock has stamped. Offset and drift of the
/// remote clock are estimated from when its stamps arrive.
///
/// A stamp arrives late by the shortest way there is, and by a random delay on top of it that is
/// never negative. So the difference of arrival and stamp has a lower edge, and over a window of
/// time that edge is a straight line, whose slope is the drift (lower_envelope).
///
/// Limits: the shortest way itself cannot be observed from one direction. It is `assumed_latency`;
/// what it is wrong by, every time is wrong by. A delay that grows for good and a remote clock that
/// was set back look the same; stamps count as late for `step_after`, and then as a clock that was
/// set.
class RemoteClock {
 public:
  struct Params {
    double window = 30.0;          ///< of stamps that are remembered [s]
    double max_skew = 2e-4;        ///< of a believable clock, either way [1]
    double assumed_latency = 0.0;  ///< of the fastest that arrive [s]
    /// A remote clock that differs by more from what is expected was set [s].
    double step = 0.1;
    /// What arrives later than expected by `step` throughout that time is no delay [s].
    double step_after = 5.0;
  };
  struct Reading {
    Time time{};             ///< of the stamp on our clock; later than that of the stamp before
    Duration age{};          ///< of the stamp when it arrived
    bool restarted = false;  ///< the remote clock was set; what was known of it is forgotten
  };

  explicit RemoteClock(const Params& params) : params_(params) {}
  RemoteClock() : RemoteClock(Params{}) {}

  /// A stamp [ns] of the remote clock, and when it arrived. From one reading to the next our time
  /// moves on by half to twice of what the remote one did, while the estimate improves, but never
  /// beyond the arrival (of several that arrive at once, by a nanosecond each).
  Reading observe(Duration stamp, Time arrival);

  /// Our seconds less the remote ones, for each remote second [1]: positive where theirs is slow.
  double skew() const { return line_.slope; }
  /// Our clock less the remote one, at the last stamp. Only after the first.
  Duration offset() const;

 private:
  bool was_set(Duration stamp, Time arrival);
  void remember(double x, double difference);
  void restart(Duration stamp, Duration difference);
  double seconds_since_base(Duration stamp) const { return to_seconds(stamp - base_stamp_); }

  Params params_;
  // Differences of arrival and stamp over the stamp, both counted from the first of them: absolute
  // times would lose nanoseconds as floating-point numbers. Only those that can ever matter.
  std::vector<EnvelopePoint> points_;
  EnvelopeLine line_;
  Duration base_stamp_{};
  Duration base_difference_{};
  Duration last_stamp_{};
  Time last_arrival_{};
  std::optional<Time> last_time_;
  std::optional<Time> late_since_;
};

}  // namespace swiftlet
