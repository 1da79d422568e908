// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/plan_form.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "gcs/mission/json_lines.hpp"
#include "gcs/mission/line_problem.hpp"
#include "gcs/mission/mavlink_item.hpp"

namespace swiftlet {
namespace {

constexpr int kPlanVersion = 1;
constexpr int kMissionVersion = 2;
constexpr int kFenceVersion = 2;

void check_version(const JsonValue& object, int known, const char* what) {
  const JsonValue& version = object.at("version");
  if (version.whole() == known) return;
  throw LineProblem(version.line(),
                    fmt::format("{} of version {} is not known, version {} is; save it again with "
                                "a QGroundControl of 2018 or later",
                                what, version.whole(), known));
}

/// [latitude, longitude], and where `count` is 3, the altitude: 0 where it is null.
GlobalPosition read_position(const JsonValue& value, std::size_t count) {
  const std::vector<JsonValue>& numbers = value.list();
  if (numbers.size() < count) {
    throw LineProblem(
        value.line(),
        fmt::format("a place has {} numbers, not {}; add what is missing", count, numbers.size()));
  }
  GlobalPosition place{numbers[0].number(), numbers[1].number(), 0.0};
  if (count > 2 && !numbers[2].is_null()) place.altitude = numbers[2].number();
  if (!place.usable()) {
    throw LineProblem(value.line(), fmt::format("{}, {}, {} is no place on Earth; correct it",
                                                place.latitude, place.longitude, place.altitude));
  }
  return place;
}

MavlinkItem read_simple_item(const JsonValue& value) {
  MavlinkItem item;
  item.line = value.line();
  item.command = value.at("command").whole();
  item.frame = value.at("frame").whole();
  if (const JsonValue* continues = value.find("autoContinue")) item.continues = continues->truth();
  const JsonValue& params = value.at("params");
  if (params.list().size() != item.params.size()) {
    throw LineProblem(params.line(), fmt::format("'params' has {} numbers, not {}; correct it",
                                                 params.list().size(), item.params.size()));
  }
  for (std::size_t i = 0; i < item.params.size(); ++i) {
    const JsonValue& param = params.list()[i];
    item.params[i] = param.is_null() ? std::numeric_limits<double>::quiet_NaN() : param.number();
  }
  return item;
}

/// The list that a survey, a corridor or a structure was made into; nothing where it was not.
const JsonValue* expanded(const JsonValue& complex) {
  const JsonValue* transects = complex.find("TransectStyleComplexItem");
  return transects != nullptr ? transects->find("Items") : complex.find("Items");
}

void read_item(const JsonValue& value, std::vector<MavlinkItem>& items, MissionFile& mission) {
  const std::string& type = value.at("type").text();
  if (type == "SimpleItem") {
    items.push_back(read_simple_item(value));
    return;
  }
  if (type != "ComplexItem") {
    throw LineProblem(value.at("type").line(),
                      fmt::format("an item of type '{}' is not known; known are SimpleItem and "
                                  "ComplexItem",
                                  type));
  }
  const std::string& kind = value.at("complexItemType").text();
  const JsonValue* parts = expanded(value);
  if (parts == nullptr || parts->list().empty()) {
    mission.remarks.push_back(
        {value.line(), fmt::format("{}: not supported, since the file does not say its waypoints; "
                                   "left out",
                                   kind)});
    return;
  }
  for (const JsonValue& part : parts->list()) items.push_back(read_simple_item(part));
  mission.remarks.push_back(
      {value.line(), fmt::format("{}: flown as the waypoints that the file has for it", kind)});
}

bool is_empty(const JsonValue* list) {
  return list == nullptr || list->is_null() || (list->is_list() && list->list().empty());
}

void read_circles(const JsonValue& circles, MissionFile& mission) {
  for (const JsonValue& value : circles.list()) {
    FenceZone zone;
    zone.line = value.line();
    zone.stay_inside = value.at("inclusion").truth();
    const JsonValue& circle = value.at("circle");
    zone.centre = read_position(circle.at("center"), 2);
    zone.radius = circle.at("radius").number();
    if (!(zone.radius > 0.0)) {
      throw LineProblem(circle.at("radius").line(),
                        fmt::format("a radius of {} m is no fence; give one above 0", zone.radius));
    }
    mission.fence.push_back(zone);
  }
}

void read_polygons(const JsonValue& polygons, MissionFile& mission) {
  for (const JsonValue& value : polygons.list()) {
    FenceZone zone;
    zone.line = value.line();
    zone.stay_inside = value.at("inclusion").truth();
    const JsonValue& corners = value.at("polygon");
    for (const JsonValue& corner : corners.list()) zone.corners.push_back(read_position(corner, 2));
    if (zone.corners.size() < 3) {
      throw LineProblem(corners.line(), fmt::format("{} corners make no area; give three or more",
                                                    zone.corners.size()));
    }
    mission.fence.push_back(zone);
  }
}

void read_fence(const JsonValue& fence, MissionFile& mission) {
  const JsonValue* version = fence.find("version");
  if (version != nullptr && version->whole() != kFenceVersion) {
    if (is_empty(fence.find("polygon"))) return;
    mission.remarks.push_back(
        {fence.line(),
         fmt::format("geoFence: version {} is not supported; left out", version->whole())});
    return;
  }
  if (!is_empty(fence.find("circles"))) read_circles(fence.at("circles"), mission);
  if (!is_empty(fence.find("polygons"))) read_polygons(fence.at("polygons"), mission);
  if (mission.fence.empty()) return;
  mission.remarks.push_back(
      {fence.line(),
       "geoFence: the mission is checked against it, the vehicle is not told; it "
       "keeps to commander.fence_radius and fence_height"});
}

void read_rally_points(const JsonValue& rally, MissionFile& mission) {
  if (is_empty(rally.find("points"))) return;
  mission.remarks.push_back(
      {rally.line(), "rallyPoints: not supported; 'return' leads to the take-off point"});
}

nlohmann::json to_json(const MavlinkItem& item, std::size_t number) {
  nlohmann::json params;
  for (const double param : item.params) {
    params.push_back(std::isnan(param) ? nlohmann::json() : nlohmann::json(param));
  }
  nlohmann::json json = {{"type", "SimpleItem"}, {"autoContinue", true}, {"command", item.command},
                         {"doJumpId", number},   {"frame", item.frame},  {"params", params}};
  if (item.frame == mav::kFrameRelative) {
    json["Altitude"] = item.altitude();
    json["AltitudeMode"] = 1;  // above home
    json["AMSLAltAboveTerrain"] = nullptr;
  }
  return json;
}

nlohmann::json to_json(const std::vector<FenceZone>& fence) {
  nlohmann::json circles = nlohmann::json::array(), polygons = nlohmann::json::array();
  for (const FenceZone& zone : fence) {
    nlohmann::json json = {{"inclusion", zone.stay_inside}, {"version", 1}};
    if (zone.corners.empty()) {
      json["circle"] = {{"center", {zone.centre.latitude, zone.centre.longitude}},
                        {"radius", zone.radius}};
      circles.push_back(json);
      continue;
    }
    for (const GlobalPosition& corner : zone.corners) {
      json["polygon"].push_back({corner.latitude, corner.longitude});
    }
    polygons.push_back(json);
  }
  return {{"circles", circles}, {"polygons", polygons}, {"version", kFenceVersion}};
}

}  // namespace

MissionFile parse_plan(const std::string& text, const MissionReading& reading) {
  const JsonValue plan = parse_json(text);
  const JsonValue& type = plan.at("fileType");
  if (type.text() != "Plan") {
    throw LineProblem(type.line(), fmt::format("'fileType' is '{}', not 'Plan'; save it as a plan "
                                               "in QGroundControl",
                                               type.text()));
  }
  check_version(plan, kPlanVersion, "a plan");
  const JsonValue* given = plan.find("mission");
  if (given == nullptr) {
    throw LineProblem(plan.line(),
                      "there is no 'mission' in this plan; make one in QGroundControl "
                      "and save it again");
  }
  check_version(*given, kMissionVersion, "a mission");
  MissionFile mission;
  std::optional<double> home_altitude = reading.home_altitude;
  if (const JsonValue* home = given->find("plannedHomePosition"); home && !home->is_null()) {
    mission.home = read_position(*home, 3);
    const bool has_altitude = !home->list()[2].is_null();
    if (!home_altitude && has_altitude) home_altitude = mission.home->altitude;
  }
  if (const JsonValue* speed = given->find("hoverSpeed"); speed && !speed->is_null()) {
    if (speed->number() > 0.0) mission.cruise_speed = speed->number();
  }
  std::vector<MavlinkItem> items;
  for (const JsonValue& item : given->at("items").list()) read_item(item, items, mission);
  add_mavlink_items(items, home_altitude, mission);
  if (const JsonValue* fence = plan.find("geoFence")) read_fence(*fence, mission);
  if (const JsonValue* rally = plan.find("rallyPoints")) read_rally_points(*rally, mission);
  return mission;
}

Result<MissionText> format_plan(const MissionFile& mission) {
  Result<MavlinkMission> translated = to_mavlink(mission);
  if (!translated.ok()) return translated.error();
  nlohmann::json items = nlohmann::json::array();
  for (const MavlinkItem& item : translated->items)
    items.push_back(to_json(item, items.size() + 1));
  const GlobalPosition& home = translated->home;
  constexpr int kAnyFirmware = 0, kQuadrotor = 2;
  nlohmann::json plan = {{"fileType", "Plan"},
                         {"groundStation", "QGroundControl"},
                         {"version", kPlanVersion},
                         {"geoFence", to_json(mission.fence)},
                         {"rallyPoints", {{"points", nlohmann::json::array()}, {"version", 2}}},
                         {"mission",
                          {{"firmwareType", kAnyFirmware},
                           {"vehicleType", kQuadrotor},
                           {"globalPlanAltitudeMode", 1},
                           {"items", items},
                           {"plannedHomePosition", {home.latitude, home.longitude, home.altitude}},
                           {"version", kMissionVersion}}}};
  if (mission.cruise_speed) plan["mission"]["hoverSpeed"] = *mission.cruise_speed;
  MissionText result{plan.dump(4) + "\n", std::move(translated->losses)};
  if (!mission.name.empty()) {
    result.losses.push_back({0, "a plan has no name; that of the mission is left out"});
  }
  return result;
}

}  // namespace swiftlet
