// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/battery/battery_clock.hpp"
#include "sensor_msgs.h"

namespace swiftlet {

inline BatteryReport from_msg(const sensor_msgs::msg::BatteryState& battery) {
  // The current is negative while the battery is discharged (sensor_msgs/BatteryState).
  return {static_cast<double>(battery.percentage()), static_cast<double>(battery.voltage()),
          -static_cast<double>(battery.current()), static_cast<double>(battery.charge())};
}

}  // namespace swiftlet
