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

/// The same with places on Earth, each `altitude` metres above the take-off point; 0 is the usual
/// altitude of GPS Guidance.
struct GlobalWaypoint {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double altitude = 0.0;   ///< [m]
};
swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<GlobalWaypoint>& waypoints);

/// Whether any of its waypoints is a place on Earth.
bool is_global(const swiftlet_msgs::msg::Mission& mission);
/// Its places in the map: above `home_z` [m] by their altitude, or by `usual_altitude` [m]. An
/// error where not all of them are on Earth.
Result<std::vector<MissionWaypoint>> global_waypoints_of(const swiftlet_msgs::msg::Mission& mission,
                                                         const LocalOrigin& origin,
                                                         double usual_altitude, double home_z);

}  // namespace swiftlet
