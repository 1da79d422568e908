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
    case Kind::kGoTo: {
      GroundCommand command;
      command.name = "goto";
      command.go_to = GroundCommand::Place{action.place.x(), action.place.y(), action.place.z()};
      return command;
    }
    case Kind::kGoToGlobal: {
      GroundCommand command;
      command.name = "gps";
      command.go_to_global = action.global;
      return command;
    }
    case Kind::kFlyMission:  // once it is on board
    case Kind::kGoOn:
      return simple("mission start", code::MISSION_START);
    case Kind::kPauseMission:
      return simple("mission pause", code::MISSION_PAUSE);
    case Kind::kClearMission:
      return simple("mission clear", code::MISSION_CLEAR);
    case Kind::kOpenClaw:
      return simple("claw open", code::CLAW_OPEN);
    case Kind::kCloseClaw:
      return simple("claw close", code::CLAW_CLOSE);
    case Kind::kTakeControl:
      return simple("control take", code::CONTROL_TAKE);
    case Kind::kReleaseControl:
      return simple("control release", code::CONTROL_RELEASE);
    case Kind::kGiveControl: {
      GroundCommand command = simple("control give", code::CONTROL_GIVE);
      command.successor = action.name;
      return command;
    }
    case Kind::kHover:
    case Kind::kFetchMission:
    case Kind::kSave:
    case Kind::kLoad:
    case Kind::kListParameters:
    case Kind::kSetParameter:
    case Kind::kNote:
    case Kind::kTell:
    case Kind::kQuit:
      break;
  }
  return simple("hover", code::HOVER);
}

}  // namespace swiftlet::screen
