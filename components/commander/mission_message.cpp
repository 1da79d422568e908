// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_message.hpp"

#include <zlib.h>

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

}  // namespace swiftlet
