// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/message.hpp"
#include "control/flight_director.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// CRC-32 of a serialisation.
std::uint32_t checksum(const Cdr& cdr);

/// CRC-32 of the waypoints' serialisation: the same for the same waypoints, whoever sends them.
std::uint32_t checksum(const swiftlet_msgs::msg::Mission& mission);

/// A mission ready to be sent, with its checksum.
swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<MissionWaypoint>& waypoints);

std::vector<MissionWaypoint> waypoints_of(const swiftlet_msgs::msg::Mission& mission);

}  // namespace swiftlet
