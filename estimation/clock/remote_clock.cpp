// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/clock/remote_clock.hpp"

#include <algorithm>

namespace swiftlet {

RemoteClock::Reading RemoteClock::observe(Duration stamp, Time arrival) {
  Reading reading;
  // Who measures it may have been held up: it was then, or before.
  arrival = last_arrival_ = std::max(arrival, last_arrival_);
  const Duration difference = arrival.time_since_epoch() - stamp;
  reading.restarted = !points_.empty() && was_set(stamp, arrival);
  const bool first = points_.empty() || reading.restarted;
  if (first) restart(stamp, difference);

  const double x = seconds_since_base(stamp);
  remember(x, to_seconds(difference - base_difference_));
  const double oldest = std::max(0.0, x - params_.window);
  line_ = lower_envelope(points_, params_.max_skew, 0.5 * (oldest + x));

  reading.time =
      Time(stamp + base_difference_ + from_seconds(line_.at(x) - params_.assumed_latency));
  if (last_time_ && !first) {
    const Duration passed = stamp - last_stamp_;
    reading.time = std::clamp(reading.time, *last_time_ + passed / 2, *last_time_ + 2 * passed);
  }
  reading.time = std::min(reading.time, arrival);
  if (last_time_) reading.time = std::max(reading.time, *last_time_ + Duration(1));
  reading.age = arrival - reading.time;
  last_time_ = reading.time;
  last_stamp_ = stamp;
  return reading;
}

/// A point that lies above all lines through a newer one, as steep as they may be, decides nothing
/// now and never will: the newer one stays longer. What remains is a few dozen points.
void RemoteClock::remember(double x, double difference) {
  const auto first = std::find_if(points_.begin(), points_.end(), [&](const EnvelopePoint& point) {
    return point.x >= x - params_.window;
  });
  points_.erase(points_.begin(), first);
  while (!points_.empty() &&
         points_.back().y >= difference + params_.max_skew * (x - points_.back().x)) {
    points_.pop_back();
  }
  points_.push_back({x, difference});
}

Duration RemoteClock::offset() const {
  return base_difference_ +
         from_seconds(line_.at(seconds_since_base(last_stamp_)) - params_.assumed_latency);
}

bool RemoteClock::was_set(Duration stamp, Time arrival) {
  if (stamp <= last_stamp_) return true;
  const Duration difference = arrival.time_since_epoch() - stamp;
  const double late_by =
      to_seconds(difference - base_difference_) - line_.at(seconds_since_base(stamp));
  if (late_by <= params_.step) {
    late_since_.reset();
    return late_by < -params_.step;  // earlier than the fastest
  }
  if (!late_since_) late_since_ = arrival;
  return to_seconds(arrival - *late_since_) > params_.step_after;
}

void RemoteClock::restart(Duration stamp, Duration difference) {
  points_.clear();
  line_ = {};
  base_stamp_ = stamp;
  base_difference_ = difference;
  late_since_.reset();
}

}  // namespace swiftlet
