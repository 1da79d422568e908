// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mavlink_item.hpp"

#include <fmt/format.h>

#include <cmath>

namespace swiftlet {
namespace {

struct CommandName {
  int command;
  const char* name;
};

/// What ground stations put into missions most, without MAV_CMD_ and NAV_.
constexpr CommandName kNames[] = {
    {16, "WAYPOINT"},
    {17, "LOITER_UNLIM"},
    {18, "LOITER_TURNS"},
    {19, "LOITER_TIME"},
    {20, "RETURN_TO_LAUNCH"},
    {21, "LAND"},
    {22, "TAKEOFF"},
    {31, "LOITER_TO_ALT"},
    {82, "SPLINE_WAYPOINT"},
    {84, "VTOL_TAKEOFF"},
    {85, "VTOL_LAND"},
    {92, "GUIDED_ENABLE"},
    {93, "DELAY"},
    {94, "PAYLOAD_PLACE"},
    {112, "CONDITION_DELAY"},
    {114, "CONDITION_DISTANCE"},
    {115, "CONDITION_YAW"},
    {177, "DO_JUMP"},
    {178, "DO_CHANGE_SPEED"},
    {179, "DO_SET_HOME"},
    {181, "DO_SET_RELAY"},
    {183, "DO_SET_SERVO"},
    {189, "DO_LAND_START"},
    {195, "DO_SET_ROI_LOCATION"},
    {197, "DO_SET_ROI_NONE"},
    {201, "DO_SET_ROI"},
    {203, "DO_DIGICAM_CONTROL"},
    {205, "DO_MOUNT_CONTROL"},
    {206, "DO_SET_CAM_TRIGG_DIST"},
    {211, "DO_GRIPPER"},
    {530, "SET_CAMERA_MODE"},
    {531, "SET_CAMERA_ZOOM"},
    {1000, "DO_GIMBAL_MANAGER_PITCHYAW"},
    {2000, "IMAGE_START_CAPTURE"},
    {2001, "IMAGE_STOP_CAPTURE"},
    {2500, "VIDEO_START_CAPTURE"},
    {2501, "VIDEO_STOP_CAPTURE"},
    {3000, "DO_VTOL_TRANSITION"},
};

}  // namespace

std::string mav_command_name(int command) {
  for (const CommandName& known : kNames) {
    if (known.command == command) return fmt::format("{} ({})", known.name, command);
  }
  return fmt::format("command {}", command);
}

bool MavlinkItem::has_place() const {
  const bool is_given = std::isfinite(latitude()) && std::isfinite(longitude());
  return is_given && (latitude() != 0.0 || longitude() != 0.0);
}

}  // namespace swiftlet
