// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "estimation/basics/time.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Of a Telemetry message as it travels, at most.
inline constexpr std::size_t kTelemetryBytes = 200;
/// The mode where no vehicle status is heard.
inline constexpr std::uint8_t kUnknownMode = 255;

/// What is known of a vehicle: null where it is not, or not any more.
struct VehicleKnowledge {
  const swiftlet_msgs::msg::VehicleStatus* status = nullptr;
  const nav_msgs::msg::Odometry* odometry = nullptr;
  const sensor_msgs::msg::BatteryState* battery = nullptr;
  const sensor_msgs::msg::NavSatFix* fix = nullptr;
  const swiftlet_msgs::msg::GuardStatus* guard = nullptr;
  const swiftlet_msgs::msg::MissionState* mission = nullptr;
  const swiftlet_msgs::msg::ClawState* claw = nullptr;
  std::optional<double> time_left;  ///< of the battery [s]
  std::uint8_t health = 0;          ///< as in DiagnosticStatus
};

/// All of it in one message of at most `kTelemetryBytes`. What is not known, or not finite, is NaN
/// and its flag is not set. The reason is the guard's while it acts, else the commander's.
swiftlet_msgs::msg::Telemetry make_telemetry(Time now, const VehicleKnowledge& known);

/// Sets the reason, or as much of its beginning as fits; no character of UTF-8 is cut.
void set_reason(swiftlet_msgs::msg::Telemetry& telemetry, const std::string& reason);

}  // namespace swiftlet
