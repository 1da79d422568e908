// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_message.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

swiftlet_msgs::msg::Waypoint make_waypoint(const MissionWaypoint& waypoint) {
  swiftlet_msgs::msg::Waypoint message;
  message.position(to_point(waypoint.position));
  message.has_yaw(waypoint.yaw.has_value());
  message.yaw(waypoint.yaw.value_or(0.0));
  message.speed(waypoint.speed.value_or(0.0));
  return message;
}

MissionWaypoint waypoint_of(const swiftlet_msgs::msg::Waypoint& message) {
  MissionWaypoint waypoint;
  waypoint.position = from_msg(message.position());
  if (message.has_yaw()) waypoint.yaw = message.yaw();
  if (message.speed() != 0.0) waypoint.speed = message.speed();
  return waypoint;
}

void set_place(const GlobalWaypoint& place, swiftlet_msgs::msg::Waypoint& message) {
  message.is_global(true);
  message.latitude(place.latitude);
  message.longitude(place.longitude);
  message.altitude(place.altitude);
}

}  // namespace

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
    mission.waypoints().push_back(make_waypoint(waypoint));
  }
  mission.checksum(checksum(mission));
  return mission;
}

std::vector<MissionWaypoint> waypoints_of(const swiftlet_msgs::msg::Mission& mission) {
  std::vector<MissionWaypoint> waypoints;
  for (const auto& item : mission.waypoints()) waypoints.push_back(waypoint_of(item));
  return waypoints;
}

swiftlet_msgs::msg::Mission make_mission(Time time, const std::string& id,
                                         const std::vector<GlobalWaypoint>& waypoints) {
  swiftlet_msgs::msg::Mission mission;
  mission.header(make_header(time, "map"));
  mission.id(id);
  for (const GlobalWaypoint& waypoint : waypoints) {
    set_place(waypoint, mission.waypoints().emplace_back());
  }
  mission.checksum(checksum(mission));
  return mission;
}

swiftlet_msgs::msg::MissionItem to_msg(const MissionItem& item) {
  swiftlet_msgs::msg::MissionItem message;
  message.kind(static_cast<std::uint8_t>(item.kind));
  message.place(make_waypoint(item.place));
  if (item.global) set_place(*item.global, message.place());
  message.altitude(item.altitude);
  message.hold(item.hold);
  message.open(item.open);
  return message;
}

Result<MissionItem> from_msg(const swiftlet_msgs::msg::MissionItem& message) {
  using Kind = MissionItem::Kind;
  MissionItem item;
  if (message.kind() > static_cast<std::uint8_t>(Kind::kClaw)) {
    return Error{fmt::format("there is no item of kind {}", message.kind())};
  }
  item.kind = static_cast<Kind>(message.kind());
  item.place = waypoint_of(message.place());
  if (message.place().is_global()) {
    item.global = GlobalWaypoint{message.place().latitude(), message.place().longitude(),
                                 message.place().altitude()};
  }
  item.hold = message.hold();
  item.altitude = message.altitude();
  item.open = message.open();
  return item;
}

std::uint32_t checksum(const std::vector<swiftlet_msgs::msg::MissionItem>& items) {
  swiftlet_msgs::msg::MissionPart bare;
  bare.items(items);
  return checksum(to_cdr(bare));
}

std::vector<swiftlet_msgs::msg::MissionPart> make_parts(
    Time time, const std::string& id, const std::vector<swiftlet_msgs::msg::MissionItem>& items,
    const std::vector<std::uint32_t>& indices) {
  std::vector<swiftlet_msgs::msg::MissionPart> parts;
  const std::uint32_t sum = checksum(items);
  for (const std::uint32_t index : indices) {
    if (index >= items.size()) continue;
    const bool continues = !parts.empty() && parts.back().items().size() < kItemsPerPart &&
                           parts.back().first() + parts.back().items().size() == index;
    if (!continues) {
      auto& part = parts.emplace_back();
      part.header(make_header(time, "map"));
      part.id(id);
      part.checksum(sum);
      part.count(static_cast<std::uint32_t>(items.size()));
      part.first(index);
    }
    parts.back().items().push_back(items[index]);
  }
  return parts;
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
    if (!item.is_global()) {
      return Error{fmt::format(
          "gps refused: waypoint {} is in the map, others are on Earth; send two missions",
          number)};
    }
    const auto place = place_of({item.latitude(), item.longitude(), item.altitude()}, origin,
                                usual_altitude, home_z);
    if (!place.ok()) {
      return Error{fmt::format("gps refused: waypoint {} is {}", number, place.error().reason)};
    }
    waypoints.push_back(waypoint_of(item));
    waypoints.back().position = *place;
  }
  return waypoints;
}

}  // namespace swiftlet
