// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet {

/// Files of QGroundControl (docs.qgroundcontrol.com, "Plan File Format"), version 1 with a mission
/// and a fence of version 2. Of a survey and its like the waypoints are flown that QGroundControl
/// made of it. Throws LineProblem.
MissionFile parse_plan(const std::string& text, const MissionReading& reading);
Result<MissionText> format_plan(const MissionFile& mission);

}  // namespace swiftlet
