// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "control/mode_machine.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// The mode as VehicleStatus has it.
inline std::uint8_t to_msg(Mode mode) {
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  switch (mode) {
    case Mode::kGrounded:
      return GROUNDED;
    case Mode::kTakeoff:
      return TAKEOFF;
    case Mode::kHover:
      return HOVER;
    case Mode::kLand:
      return LAND;
    case Mode::kManual:
      return MANUAL;
    case Mode::kAssistedManual:
      return ASSISTED_MANUAL;
    case Mode::kGpsGuidance:
      return GPS_GUIDANCE;
    case Mode::kIndoorNavigation:
      return INDOOR_NAVIGATION;
    case Mode::kIndoorExploration:
      return INDOOR_EXPLORATION;
  }
  return GROUNDED;
}

/// The mode of a VehicleStatus as people read it.
inline const char* mode_name(std::uint8_t message) {
  for (const Mode mode : kModes) {
    if (to_msg(mode) == message) return to_string(mode);
  }
  return "a mode that this program does not know";
}

}  // namespace swiftlet
