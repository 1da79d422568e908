// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_message.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "components/conversions.hpp"

namespace swiftlet {

std::uint32_t checksum(const Cdr& cdr) {
  return static_cast<std::uint32_t>(
      crc32(crc32(0, nullptr, 0), cdr.data(), static_cast<uInt>(cdr.size())));
}

std::uint32_t checksum(const swiftlet_msgs::msg::Mission& mission) {
  swiftlet_msgs::msg::Mission bare;
  bare.waypoints(mission.waypoints());
  return checksum(to_cdr(bare));
}

swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<MissionWaypoint>& waypoints) {
  swiftlet_msgs::msg::Mission mission;
  mission.header(make_header(time, "map"));
  mission.id(id);
  for (const MissionWaypoint& waypoint : waypoints) {
    swiftlet_msgs::msg::Waypoint item;
    item.position(to_point(waypoint.position));
    item.has_yaw(waypoint.yaw.has_value());
    item.yaw(waypoint.yaw.value_or(0.0));
    mission.waypoints().push_back(item);
  }
  mission.checksum(checksum(mission));
  return mission;
}

std::vector<MissionWaypoint> waypoints_of(const swiftlet_msgs::msg::Mission& mission) {
  std::vector<MissionWaypoint> waypoints;
  for (const auto& item : mission.waypoints()) {
    MissionWaypoint waypoint;
    waypoint.position = from_msg(item.position());
    if (item.has_yaw()) waypoint.yaw = item.yaw();
    waypoints.push_back(waypoint);
  }
  return waypoints;
}

swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<GlobalWaypoint>& waypoints) {
  swiftlet_msgs::msg::Mission mission;
  mission.header(make_header(time, "map"));
  mission.id(id);
  for (const GlobalWaypoint& waypoint : waypoints) {
    swiftlet_msgs::msg::Waypoint item;
    item.is_global(true);
    item.latitude(waypoint.latitude);
    item.longitude(waypoint.longitude);
    item.altitude(waypoint.altitude);
    mission.waypoints().push_back(item);
  }
  mission.checksum(checksum(mission));
  return mission;
}

bool is_global(const swiftlet_msgs::msg::Mission& mission) {
  return std::any_of(mission.waypoints().begin(), mission.waypoints().end(),
                     [](const auto& item) { return item.is_global(); });
}

Result<std::vector<MissionWaypoint>> global_waypoints_of(const swiftlet_msgs::msg::Mission& mission,
                                                         const LocalOrigin& origin,
                                                         double usual_altitude, double home_z) {
  std::vector<MissionWaypoint> waypoints;
  for (const auto& item : mission.waypoints()) {
    const std::size_t number = waypoints.size() + 1;
    const GlobalPosition place{item.latitude(), item.longitude(), origin.position().altitude};
    if (!item.is_global()) {
      return Error{fmt::format(
          "gps refused: waypoint {} is in the map, others are on Earth; send two missions",
          number)};
    }
    if (!place.usable() || !(item.altitude() >= 0.0 && std::isfinite(item.altitude()))) {
      return Error{fmt::format("gps refused: waypoint {} is no place on Earth", number)};
    }
    const double altitude = item.altitude() > 0.0 ? item.altitude() : usual_altitude;
    MissionWaypoint waypoint;
    waypoint.position = origin.to_map(place);
    waypoint.position.z() = home_z + altitude;
    waypoints.push_back(waypoint);
  }
  return waypoints;
}

}  // namespace swiftlet
