// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "swiftlet_msgs.h"

namespace swiftlet {

/// A mode of VehicleStatus as people read it.
inline const char* mode_name(std::uint8_t mode) {
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  switch (mode) {
    case GROUNDED:
      return "Grounded";
    case TAKEOFF:
      return "Takeoff";
    case HOVER:
      return "Hover";
    case LAND:
      return "Land";
    case INDOOR_NAVIGATION:
      return "Indoor Navigation";
    default:
      return "unknown mode";
  }
}

}  // namespace swiftlet
