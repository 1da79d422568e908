// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/ground_commands.hpp"

namespace swiftlet::screen {
namespace {

GroundCommand simple(const char* name, std::uint8_t code) {
  GroundCommand command;
  command.name = name;
  command.command = code;
  return command;
}

}  // namespace

GroundCommand ground_command(const Action& action) {
  namespace code = swiftlet_msgs::msg::ModeCommand_Constants;
  using Kind = Action::Kind;
  switch (action.kind) {
    case Kind::kArm:
      return simple("arm", code::ARM);
    case Kind::kDisarm:
      return simple("disarm", code::DISARM);
    case Kind::kTakeoff: {
      GroundCommand command = simple("takeoff", code::TAKEOFF);
      command.altitude = action.altitude;
      return command;
    }
    case Kind::kLand:
      return simple("land", code::LAND);
    case Kind::kReturn:
      return simple("return", code::RETURN);
    case Kind::kExplore:
      return simple("explore", code::EXPLORE);
    case Kind::kManual:
      return simple("manual", code::MANUAL);
    case Kind::kAssist:
      return simple("assist", code::ASSIST);
    case Kind::kMission: {
      GroundCommand command;
      command.name = action.name;
      command.mission = action.waypoints;
      return command;
    }
    case Kind::kHover:
    case Kind::kListParameters:
    case Kind::kSetParameter:
    case Kind::kQuit:
      break;
  }
  return simple("hover", code::HOVER);
}

}  // namespace swiftlet::screen
