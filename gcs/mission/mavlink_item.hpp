// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet {

/// MAV_CMD of MAVLink's common dialect, as far as they are flown here.
namespace mav {
inline constexpr int kWaypoint = 16;
inline constexpr int kLoiterUnlimited = 17;
inline constexpr int kLoiterTurns = 18;
inline constexpr int kLoiterTime = 19;
inline constexpr int kReturnToLaunch = 20;
inline constexpr int kLand = 21;
inline constexpr int kTakeoff = 22;
inline constexpr int kSplineWaypoint = 82;
inline constexpr int kDelay = 93;
inline constexpr int kChangeSpeed = 178;
inline constexpr int kGripper = 211;

// MAV_FRAME.
inline constexpr int kFrameSea = 0;       ///< altitude above sea
inline constexpr int kFrameMission = 2;   ///< no place
inline constexpr int kFrameRelative = 3;  ///< altitude above home
}  // namespace mav

/// MAV_CMD_NAV_WAYPOINT as "WAYPOINT (16)"; of one that is not known, its number.
std::string mav_command_name(int command);

/// One line of a mission in MAVLink's terms. What is not given is NaN.
struct MavlinkItem {
  int line = 0;
  int frame = mav::kFrameRelative;
  int command = mav::kWaypoint;
  /// param1 to 4, latitude, longitude [deg], altitude [m].
  std::array<double, 7> params{};
  bool continues = true;  ///< with the next without being told to

  double yaw_deg() const { return params[3]; }  ///< clockwise from north
  double latitude() const { return params[4]; }
  double longitude() const { return params[5]; }
  double altitude() const { return params[6]; }
  bool has_place() const;  ///< neither NaN nor 0, 0, which stand for "here"
};

/// Translates them, and adds them to `mission`, with remarks on what is not flown as they say.
/// `home_altitude` is needed where altitudes are above sea [m]. Throws LineProblem.
void add_mavlink_items(const std::vector<MavlinkItem>& items, std::optional<double> home_altitude,
                       MissionFile& mission);

struct MavlinkMission {
  GlobalPosition home;
  std::vector<MavlinkItem> items;
  std::vector<MissionRemark> losses;
};
/// An error where MAVLink's files cannot hold it.
Result<MavlinkMission> to_mavlink(const MissionFile& mission);

}  // namespace swiftlet
