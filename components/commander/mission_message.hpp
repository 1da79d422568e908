// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/message.hpp"
#include "control/flight_director.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/geodesy/local_origin.hpp"
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

/// The same with places on Earth.
swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<GlobalWaypoint>& waypoints);

/// The same as a step of a mission that is uploaded.
swiftlet_msgs::msg::MissionItem to_msg(const MissionItem& item);
/// An error where it is of a kind that this program does not know.
Result<MissionItem> from_msg(const swiftlet_msgs::msg::MissionItem& message);

/// CRC-32 of the items' serialisation: the same for the same items, whoever sends them.
std::uint32_t checksum(const std::vector<swiftlet_msgs::msg::MissionItem>& items);

/// So many items fit into a datagram, headers included, on every link that carries IP.
inline constexpr std::size_t kItemsPerPart = 8;
/// Of what is missing, a MissionState names so many; the others when these are here.
inline constexpr std::size_t kMostNamedMissing = 100;
/// Items by their indices, in as few parts as may be; an index that is not there is left out.
std::vector<swiftlet_msgs::msg::MissionPart> make_parts(
    Time time, const std::string& id, const std::vector<swiftlet_msgs::msg::MissionItem>& items,
    const std::vector<std::uint32_t>& indices);

/// Whether any of its waypoints is a place on Earth.
bool is_global(const swiftlet_msgs::msg::Mission& mission);
/// Its places in the map: above `home_z` [m] by their altitude, or by `usual_altitude` [m]. An
/// error where not all of them are on Earth.
Result<std::vector<MissionWaypoint>> global_waypoints_of(const swiftlet_msgs::msg::Mission& mission,
                                                         const LocalOrigin& origin,
                                                         double usual_altitude, double home_z);

}  // namespace swiftlet
