// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_text.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "gcs/mission/degrees.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;
using Json = nlohmann::ordered_json;

std::string yaw_degrees(const MissionItem& item) {
  return shortest_degrees(*item.place.yaw, from_degrees);
}

std::string waypoint_text(const MissionItem& item) {
  std::string text;
  if (item.global) {
    text = fmt::format("gps {:.7f} {:.7f}", item.global->latitude, item.global->longitude);
    if (item.global->altitude > 0.0) text += fmt::format(" at {:g} m", item.global->altitude);
  } else {
    const Eigen::Vector3d& place = item.place.position;
    text = fmt::format("goto {:.2f} {:.2f} {:.2f} m", place.x(), place.y(), place.z());
  }
  if (item.place.yaw) text += fmt::format(", yaw {} deg", yaw_degrees(item));
  if (item.place.speed) text += fmt::format(", {:g} m/s", *item.place.speed);
  if (item.hold > 0.0) text += fmt::format(", hold {:g} s", item.hold);
  return text;
}

void add_waypoint(Json& json, const MissionItem& item) {
  if (item.global) {
    json["latitude"] = item.global->latitude;
    json["longitude"] = item.global->longitude;
    if (item.global->altitude > 0.0) json["altitude"] = item.global->altitude;
    if (item.place.speed) json["speed"] = *item.place.speed;
  } else {
    json["x"] = item.place.position.x();
    json["y"] = item.place.position.y();
    json["z"] = item.place.position.z();
  }
  if (item.place.yaw) json["yaw_deg"] = std::strtod(yaw_degrees(item).c_str(), nullptr);
  if (item.hold > 0.0) json["hold"] = item.hold;
}

Json json_of(const MissionItem& item) {
  Json json;
  switch (item.kind) {
    case Kind::kTakeoff:
      json["kind"] = "takeoff";
      json["altitude"] = item.altitude;
      break;
    case Kind::kWaypoint:
      json["kind"] = item.global ? "gps" : "goto";
      add_waypoint(json, item);
      break;
    case Kind::kHold:
      json["kind"] = "hold";
      json["hold"] = item.hold;
      break;
    case Kind::kLand:
      json["kind"] = "land";
      break;
    case Kind::kReturn:
      json["kind"] = "return";
      break;
    case Kind::kClaw:
      json["kind"] = "claw";
      json["open"] = item.open;
      break;
  }
  return json;
}

}  // namespace

std::string item_text(const MissionItem& item) {
  switch (item.kind) {
    case Kind::kTakeoff:
      return fmt::format("takeoff to {:g} m", item.altitude);
    case Kind::kWaypoint:
      return waypoint_text(item);
    case Kind::kHold:
      return fmt::format("hold {:g} s", item.hold);
    case Kind::kLand:
      return "land";
    case Kind::kReturn:
      return "return";
    case Kind::kClaw:
      return item.open ? "claw open" : "claw close";
  }
  return "";
}

std::string mission_table(const std::vector<MissionItem>& items) {
  std::string table;
  for (std::size_t i = 0; i < items.size(); ++i) {
    table += fmt::format("{:>4}  {}\n", i + 1, item_text(items[i]));
  }
  return table;
}

std::string mission_json(const std::vector<MissionItem>& items) {
  Json list = Json::array();
  for (std::size_t i = 0; i < items.size(); ++i) {
    Json json = {{"item", i + 1}};
    json.update(json_of(items[i]));
    list.push_back(std::move(json));
  }
  return list.dump(2);
}

}  // namespace swiftlet
