// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/flight_story.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

/// Of topics that come at least ten times a second [s].
constexpr double kLongestGap = 0.5;
/// Three periods of the battery [s].
constexpr double kLongestBatteryGap = 3.0;

ThinnedCurve line(double duration) {
  return {duration, kLongestGap};
}
Curve3 lines(double duration) {
  return {line(duration), line(duration), line(duration)};
}
ThinnedCurve battery_line(double duration) {
  return {duration, kLongestBatteryGap};
}

}  // namespace

FlightCurves::FlightCurves(double duration)
    : estimate(lines(duration)),
      setpoint(lines(duration)),
      truth(lines(duration)),
      error(lines(duration)),
      estimate_error(lines(duration)),
      sigma(lines(duration)),
      speed(line(duration)),
      setpoint_speed(line(duration)),
      climb_rate(line(duration)),
      roll(line(duration)),
      pitch(line(duration)),
      yaw(line(duration)),
      setpoint_yaw(line(duration)),
      battery_percentage(battery_line(duration)),
      battery_voltage(battery_line(duration)),
      battery_current(battery_line(duration)) {}

bool FlightStory::has(const std::string& topic) const {
  return std::any_of(topics.begin(), topics.end(), [&topic](const TopicHealth& health) {
    return health.topic == topic && health.messages > health.unreadable;
  });
}

}  // namespace swiftlet
