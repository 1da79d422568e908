// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet {

/// MAVLink's plain text, "QGC WPL 110" (mavlink.io, "Waypoint/mission plain-text file format"). A
/// first item that is a WAYPOINT with an altitude above sea is home, as Mission Planner writes it.
/// A heading of 0 is none there: tools write it where there is none; north is 360. Throws
/// LineProblem.
MissionFile parse_waypoints(const std::string& text, const MissionReading& reading);
Result<MissionText> format_waypoints(const MissionFile& mission);

}  // namespace swiftlet
