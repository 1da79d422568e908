// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/topic_health.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "components/topics.hpp"

namespace swiftlet {
namespace {

/// As the runtime judges a writer: after three periods it is as good as dead.
constexpr double kPeriodsOfSilence = 3.0;
constexpr double kRateTolerance = 0.02;

template <class T>
std::pair<const std::string, TopicPromise> entry(const Topic<T>& topic, bool is_sensor) {
  TopicPromise promise;
  promise.is_sensor = is_sensor;
  if (topic.period > Duration(0)) promise.period = to_seconds(topic.period);
  return {topic.name, promise};
}

/// Without what comes only while a person is there: sticks and the ground station.
const std::map<std::string, TopicPromise>& promises() {
  static const std::map<std::string, TopicPromise> promises{
      entry(topic::imu0, true),       entry(topic::imu1, true),
      entry(topic::imu2, true),       entry(topic::range_down, true),
      entry(topic::scan, true),       entry(topic::battery, true),
      entry(topic::phone_pose, true), entry(topic::gps_fix, true),
      entry(topic::clock, false),     entry(topic::odometry, false),
      entry(topic::map, false),       entry(topic::vehicle_status, false),
      entry(topic::setpoint, false),  entry(topic::guard_status, false),
      entry(topic::motors, false),    entry(topic::sim_truth, false),
  };
  return promises;
}

}  // namespace

double TopicHealth::rate_hz() const {
  return messages > 1 && last > first ? static_cast<double>(messages - 1) / (last - first) : 0.0;
}

bool TopicHealth::too_slow() const {
  return period && messages > 1 && rate_hz() * *period < 1.0 - kRateTolerance;
}

TopicWatch::TopicWatch(std::string topic, std::string type) {
  const TopicPromise promise = promise_of(topic);
  health_.is_sensor = promise.is_sensor;
  health_.period = promise.period;
  health_.topic = std::move(topic);
  health_.type = std::move(type);
}

std::optional<double> TopicWatch::add(double time) {
  const std::uint64_t silences = health_.silences;
  const double gap = time - health_.last;
  if (health_.messages++ == 0) {
    health_.first = time;
  } else {
    note_gap(gap, health_.last);
  }
  health_.last = time;
  return health_.silences > silences ? std::make_optional(gap) : std::nullopt;
}

void TopicWatch::note_gap(double gap, double at) {
  if (gap > health_.largest_gap) {
    health_.largest_gap = gap;
    health_.largest_gap_at = at;
  }
  if (health_.period && gap > kPeriodsOfSilence * *health_.period) ++health_.silences;
}

TopicHealth TopicWatch::finish(double end) const {
  TopicWatch ended = *this;
  if (health_.messages > 0 && health_.period) ended.note_gap(end - health_.last, health_.last);
  return ended.health_;
}

TopicPromise promise_of(const std::string& topic) {
  const auto found = promises().find(topic);
  return found == promises().end() ? TopicPromise{} : found->second;
}

std::vector<std::string> sensor_topics() {
  std::vector<std::string> topics;
  for (const auto& [name, promise] : promises()) {
    if (promise.is_sensor) topics.push_back(name);
  }
  return topics;
}

}  // namespace swiftlet
