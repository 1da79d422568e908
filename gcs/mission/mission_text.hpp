// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "control/mission.hpp"

namespace swiftlet {

/// "goto 2.00 4.00 1.20 m, yaw 90 deg, hold 2 s": an item as a person reads it.
std::string item_text(const MissionItem& item);

/// A line an item, numbered from 1.
std::string mission_table(const std::vector<MissionItem>& items);

/// A list of objects in JSON, with the keys of the YAML form, lengths in m, and angles in deg:
/// {"item": 2, "kind": "goto", "x": 2.0, "y": 4.0, "z": 1.2, "yaw_deg": 90.0, "hold": 2.0}.
std::string mission_json(const std::vector<MissionItem>& items);

}  // namespace swiftlet
