// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "estimation/basics/time.hpp"
#include "estimation/battery/discharge_estimate.hpp"

namespace swiftlet {

/// What a battery says of itself. What it does not measure is NaN, as in sensor_msgs/BatteryState.
struct BatteryReport {
  double percentage = 0.0;  ///< of its capacity [0..1]
  double voltage = 0.0;     ///< [V]
  double current = 0.0;     ///< drawn [A]
  double charge = 0.0;      ///< left [A h]
};

/// How long a battery lasts when the vehicle goes on as it did: the charge that is left over the
/// mean current, or, where one of these is not measured, what the slope of the percentage says.
class BatteryClock {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(30);  ///< of the mean current

  void add(const BatteryReport& report, Time now);
  /// Until it is empty [s]; nothing where that is not known, or nothing was heard for
  /// DischargeEstimate::Params::longest_gap.
  std::optional<double> seconds_left(Time now) const;

 private:
  struct Sample {
    Time time;
    BatteryReport report;
  };
  std::deque<Sample> samples_;  // one a second at most
  DischargeEstimate slope_;
};

}  // namespace swiftlet
