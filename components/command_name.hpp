// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "swiftlet_msgs.h"

namespace swiftlet {

/// A ModeCommand's command as the verb that gives it.
inline std::string command_name(std::uint8_t command) {
  using namespace swiftlet_msgs::msg::ModeCommand_Constants;
  switch (command) {
    case ARM:
      return "arm";
    case DISARM:
      return "disarm";
    case TAKEOFF:
      return "takeoff";
    case HOVER:
      return "hover";
    case LAND:
      return "land";
    case EXPLORE:
      return "explore";
    case MANUAL:
      return "manual";
    case ASSIST:
      return "assist";
    case RETURN:
      return "return";
    case MISSION_START:
      return "mission start";
    case MISSION_PAUSE:
      return "mission pause";
    case MISSION_CLEAR:
      return "mission clear";
    case CLAW_OPEN:
      return "claw open";
    case CLAW_CLOSE:
      return "claw close";
    case CONTROL_TAKE:
      return "control take";
    case CONTROL_GIVE:
      return "control give";
    case CONTROL_RELEASE:
      return "control release";
    default:
      return "a command that this program does not know";
  }
}

}  // namespace swiftlet
