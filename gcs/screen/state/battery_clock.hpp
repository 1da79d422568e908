// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "estimation/basics/time.hpp"

namespace swiftlet::screen {

/// What a battery says of itself. What it does not measure is NaN, as in sensor_msgs/BatteryState.
struct BatteryReport {
  double percentage = 0.0;  ///< of its capacity [0..1]
  double voltage = 0.0;     ///< [V]
  double current = 0.0;     ///< drawn [A]
  double charge = 0.0;      ///< left [A h]
};

/// How long a battery lasts when the vehicle goes on as it did: the charge that is left over the
/// mean current, or, where that is not measured, the percentage over its slope.
class BatteryClock {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(30);
  /// The slope counts from so much time on, and from so much used.
  static constexpr Duration kShortest = std::chrono::seconds(10);
  static constexpr double kLeastUsed = 0.005;

  void add(const BatteryReport& report, Time now);
  /// Nothing where it is not known [s].
  std::optional<double> seconds_left() const;

 private:
  struct Sample {
    Time time;
    BatteryReport report;
  };
  std::deque<Sample> samples_;  // one a second
};

}  // namespace swiftlet::screen
