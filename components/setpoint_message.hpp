// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "control/flight_loop.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// The kind as Setpoint has it.
inline std::uint8_t to_msg(SetpointKind kind) {
  using namespace swiftlet_msgs::msg::Setpoint_Constants;
  if (kind == SetpointKind::kTrack) return TRACK;
  return kind == SetpointKind::kLevel ? LEVEL : MOTORS_OFF;
}

/// What is unknown is off.
inline SetpointKind setpoint_kind_of(std::uint8_t message) {
  using namespace swiftlet_msgs::msg::Setpoint_Constants;
  if (message == TRACK) return SetpointKind::kTrack;
  return message == LEVEL ? SetpointKind::kLevel : SetpointKind::kMotorsOff;
}

}  // namespace swiftlet
