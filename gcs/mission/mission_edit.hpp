// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "control/mission.hpp"
#include "estimation/basics/result.hpp"

/// Changes to a mission, item by item; items are counted from 1. An error says what is wrong and
/// leaves the mission as it was.
namespace swiftlet {

/// Puts a waypoint before item `at`; without, at the end, but before a landing or a return that
/// ends the mission. Its number then.
Result<std::size_t> add_waypoint(std::vector<MissionItem>& items, const MissionItem& waypoint,
                                 std::optional<std::size_t> at);

/// Puts waypoint `number` elsewhere: where `waypoint` is. What `waypoint` does not say (yaw, speed,
/// hold) stays as it was.
Status move_waypoint(std::vector<MissionItem>& items, std::size_t number,
                     const MissionItem& waypoint);

/// Takes out an item of any kind.
Status remove_item(std::vector<MissionItem>& items, std::size_t number);

}  // namespace swiftlet
