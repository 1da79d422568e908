// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/yaml_form.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "components/runtime/config/config.hpp"
#include "gcs/mission/degrees.hpp"
#include "gcs/mission/line_problem.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;

constexpr Range kLatitude{-90.0, 90.0};
constexpr Range kLongitude{-360.0, 360.0};
constexpr Range kSeaLevel{-1e5, 1e5};  // [m]

template <class... R>
std::optional<double> optional_number(const Config& config, const char* key, R... range) {
  if (!config.has(key)) return std::nullopt;
  double value = 0.0;
  config.require(key, value, range...);
  return value;
}

GlobalPosition read_position(const Config& config) {
  GlobalPosition position;
  config.require("latitude", position.latitude, kLatitude);
  config.require("longitude", position.longitude, kLongitude);
  return position;
}

void read_waypoint(const Config& config, MissionItem& item) {
  item.kind = Kind::kWaypoint;
  if (const auto degrees = optional_number(config, "yaw_deg")) {
    item.place.yaw = from_degrees(*degrees);
  }
  config.read("hold", item.hold, kNotNegative);
}

void read_goto(const Config& config, MissionItem& item) {
  config.require("x", item.place.position.x());
  config.require("y", item.place.position.y());
  config.require("z", item.place.position.z());
  read_waypoint(config, item);
}

void read_gps(const Config& config, MissionItem& item) {
  const GlobalPosition position = read_position(config);
  item.global = GlobalWaypoint{position.latitude, position.longitude, 0.0};
  item.global->altitude = optional_number(config, "altitude", kPositive).value_or(0.0);
  item.place.speed = optional_number(config, "speed", kPositive);
  read_waypoint(config, item);
}

void read_claw(const Config& step, MissionItem& item) {
  std::string what;
  step.require("claw", what);
  item.kind = Kind::kClaw;
  item.open = what == "open";
  if (!item.open && what != "close") {
    step.fail("claw", fmt::format("'claw' must be open or close, not '{}'", what));
  }
}

WrittenItem read_item(const Config& step) {
  WrittenItem written;
  const std::string key =
      step.only_key({"takeoff", "goto", "gps", "hold", "claw", "land", "return"});
  written.line = step.line(key);
  MissionItem& item = written.item;
  if (key == "takeoff") {
    item.kind = Kind::kTakeoff;
    step.require(key, item.altitude, kNotNegative);
  } else if (key == "goto") {
    read_goto(step.child(key), item);
  } else if (key == "gps") {
    read_gps(step.child(key), item);
  } else if (key == "hold") {
    item.kind = Kind::kHold;
    step.require(key, item.hold, kNotNegative);
  } else if (key == "claw") {
    read_claw(step, item);
  } else {
    item.kind = key == "land" ? Kind::kLand : Kind::kReturn;
    step.require_nothing(key);
  }
  if (const std::string problem = problem_of(item); !problem.empty()) step.fail(key, problem);
  return written;
}

FenceZone read_zone(const Config& config) {
  FenceZone zone;
  zone.line = config.line();
  std::string stay;
  config.require("stay", stay);
  zone.stay_inside = stay == "inside";
  if (!zone.stay_inside && stay != "outside") {
    config.fail("stay", fmt::format("'stay' must be inside or outside, not '{}'", stay));
  }
  if (config.has("corners")) {
    for (const Config& corner : config.list("corners")) {
      zone.corners.push_back(read_position(corner));
    }
    if (zone.corners.size() < 3) {
      config.fail("corners",
                  fmt::format("{} corners make no area; give three or more", zone.corners.size()));
    }
    return zone;
  }
  zone.centre = read_position(config);
  config.require("radius", zone.radius, kPositive);
  return zone;
}

/// A mapping on one line, of what is there.
class FlowMapping {
 public:
  explicit FlowMapping(YAML::Emitter& yaml) : yaml_(yaml) { yaml_ << YAML::Flow << YAML::BeginMap; }
  ~FlowMapping() { yaml_ << YAML::EndMap; }
  FlowMapping(const FlowMapping&) = delete;
  FlowMapping& operator=(const FlowMapping&) = delete;

  FlowMapping& add(const char* key, const std::string& value) {
    yaml_ << YAML::Key << key << YAML::Value << value;
    return *this;
  }
  /// In the shortest form that reads as the same number.
  FlowMapping& add(const char* key, double value) { return add(key, fmt::format("{}", value)); }
  FlowMapping& add(const GlobalPosition& position) {
    return add("latitude", position.latitude).add("longitude", position.longitude);
  }

 private:
  YAML::Emitter& yaml_;
};

void write_waypoint(YAML::Emitter& yaml, const MissionItem& item) {
  FlowMapping mapping(yaml);
  if (item.global) {
    mapping.add("latitude", item.global->latitude).add("longitude", item.global->longitude);
    if (item.global->altitude > 0.0) mapping.add("altitude", item.global->altitude);
    if (item.place.speed) mapping.add("speed", *item.place.speed);
  } else {
    const Eigen::Vector3d& place = item.place.position;
    mapping.add("x", place.x()).add("y", place.y()).add("z", place.z());
  }
  if (item.place.yaw) mapping.add("yaw_deg", shortest_degrees(*item.place.yaw, from_degrees));
  if (item.hold > 0.0) mapping.add("hold", item.hold);
}

void write_item(YAML::Emitter& yaml, const MissionItem& item) {
  if (item.kind == Kind::kLand || item.kind == Kind::kReturn) {
    yaml << (item.kind == Kind::kLand ? "land" : "return");
    return;
  }
  yaml << YAML::BeginMap << YAML::Key;
  if (item.kind == Kind::kTakeoff) {
    yaml << "takeoff" << YAML::Value << fmt::format("{}", item.altitude);
  } else if (item.kind == Kind::kHold) {
    yaml << "hold" << YAML::Value << fmt::format("{}", item.hold);
  } else if (item.kind == Kind::kClaw) {
    yaml << "claw" << YAML::Value << (item.open ? "open" : "close");
  } else {
    yaml << (item.global ? "gps" : "goto") << YAML::Value;
    write_waypoint(yaml, item);
  }
  yaml << YAML::EndMap;
}

void write_zone(YAML::Emitter& yaml, const FenceZone& zone) {
  const char* stay = zone.stay_inside ? "inside" : "outside";
  if (zone.corners.empty()) {
    FlowMapping(yaml).add("stay", stay).add(zone.centre).add("radius", zone.radius);
    return;
  }
  yaml << YAML::BeginMap << YAML::Key << "stay" << YAML::Value << stay;
  yaml << YAML::Key << "corners" << YAML::Value << YAML::BeginSeq;
  for (const GlobalPosition& corner : zone.corners) FlowMapping(yaml).add(corner);
  yaml << YAML::EndSeq << YAML::EndMap;
}

void write_head(YAML::Emitter& yaml, const MissionFile& mission) {
  if (!mission.name.empty() || mission.cruise_speed) {
    yaml << YAML::Key << "mission" << YAML::Value << YAML::BeginMap;
    if (!mission.name.empty()) {
      yaml << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << mission.name;
    }
    if (mission.cruise_speed) {
      yaml << YAML::Key << "cruise_speed" << YAML::Value
           << fmt::format("{}", *mission.cruise_speed);
    }
    yaml << YAML::EndMap;
  }
  if (mission.home) {
    yaml << YAML::Key << "home" << YAML::Value;
    FlowMapping(yaml).add(*mission.home).add("altitude", mission.home->altitude);
  }
}

}  // namespace

MissionFile parse_yaml_mission(const std::string& text, const std::string& name) {
  const Config file = Config::parse(text, name);
  MissionFile mission;
  const Config head = file.child("mission");
  head.read("name", mission.name);
  mission.cruise_speed = optional_number(head, "cruise_speed", kPositive);
  if (file.has("home")) {
    const Config home = file.child("home");
    mission.home = read_position(home);
    home.require("altitude", mission.home->altitude, kSeaLevel);
  }
  for (const Config& zone : file.list("fence")) mission.fence.push_back(read_zone(zone));
  file.demand("items");
  for (const Config& step : file.steps("items")) mission.items.push_back(read_item(step));
  file.finish();
  return mission;
}

std::string format_yaml_mission(const MissionFile& mission) {
  YAML::Emitter yaml;
  yaml << YAML::BeginMap;
  write_head(yaml, mission);
  if (!mission.fence.empty()) {
    yaml << YAML::Key << "fence" << YAML::Value << YAML::BeginSeq;
    for (const FenceZone& zone : mission.fence) write_zone(yaml, zone);
    yaml << YAML::EndSeq;
  }
  yaml << YAML::Key << "items" << YAML::Value << YAML::BeginSeq;
  for (const WrittenItem& written : mission.items) write_item(yaml, written.item);
  yaml << YAML::EndSeq << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace swiftlet
