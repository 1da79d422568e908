// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/scenario.hpp"

#include <fmt/format.h>

#include <set>

#include "components/sim/scenario_vehicle.hpp"

namespace swiftlet {

namespace {

/// A number that may be left out.
void read_optional(const Config& config, const std::string& key, std::optional<double>& value,
                   Range range = {}) {
  if (!config.has(key)) return;
  double number = 0.0;
  config.read(key, number, range);
  value = number;
}

void read_start(const Config& config, Scenario::Start& start) {
  config.read("x", start.x);
  config.read("y", start.y);
  read_optional(config, "z", start.z);
  config.read("yaw", start.yaw);
}

void read_wind(const Config& config, Wind::Params& wind) {
  config.read("mean", wind.mean, {-50.0, 50.0});
  config.read("gust_intensity", wind.gust_intensity, {0.0, 20.0});
  config.read("gust_time_constant", wind.gust_time_constant, kPositive);
}

void read_mission(const Config& config, Scenario::Mission& mission) {
  config.read("takeoff_altitude", mission.takeoff_altitude, kPositive);
  for (const Config& item : config.list("waypoints")) {
    Scenario::Waypoint waypoint;
    item.require("x", waypoint.x);
    item.require("y", waypoint.y);
    read_optional(item, "z", waypoint.z, kPositive);
    read_optional(item, "yaw", waypoint.yaw);
    mission.waypoints.push_back(waypoint);
  }
  config.read("explore", mission.explore);
  if (mission.explore && !mission.waypoints.empty()) {
    config.fail("explore", "an exploration has no waypoints; leave one of the two out");
  }
  config.read("return_to_pad", mission.return_to_pad);
  config.read("land", mission.land);
}

void read_obstacles(const Config& config, std::vector<Scenario::Obstacle>& obstacles) {
  std::set<std::string> names;
  for (const Config& item : config.list("obstacles")) {
    Scenario::Obstacle obstacle;
    item.require("name", obstacle.name);
    if (!names.insert(obstacle.name).second) {
      item.fail("name", fmt::format("there is an obstacle '{}' already; name this one differently",
                                    obstacle.name));
    }
    item.require("position", obstacle.position);
    item.require("size", obstacle.size, kPositive);
    item.read("yaw", obstacle.yaw);
    item.read("appears_at_s", obstacle.appears_at_s, kNotNegative);
    read_optional(item, "disappears_at_s", obstacle.disappears_at_s, kNotNegative);
    obstacles.push_back(obstacle);
  }
}

void read_pushes(const Config& config, std::vector<Scenario::Push>& pushes) {
  for (const Config& item : config.list("pushes")) {
    Scenario::Push push;
    item.require("at_s", push.at_s, kNotNegative);
    item.require("duration_s", push.duration_s, kPositive);
    item.require("force", push.force, Range{-1000.0, 1000.0});
    pushes.push_back(push);
  }
}

void read_map(const Config& config, Scenario::MapBounds& map) {
  config.read("min", map.min);
  config.read("max", map.max);
  config.read("resolution", map.resolution, {0.01, 1.0});
  if (!(map.max.array() > map.min.array()).all()) {
    config.fail("max", "'max' must be more than 'min' on both axes");
  }
  constexpr double kMostCells = 1e8;
  if ((map.max - map.min).prod() / (map.resolution * map.resolution) > kMostCells) {
    config.fail("resolution",
                "the map has more than 100 million cells; use a coarser 'resolution'");
  }
}

}  // namespace

Scenario Scenario::load(const std::filesystem::path& file) {
  return read(Config::load(file));
}

Scenario Scenario::read(const Config& config) {
  Scenario scenario;
  config.require("name", scenario.name);
  config.read("description", scenario.description);
  int seed = static_cast<int>(scenario.seed);
  config.read("seed", seed, kNotNegative);
  scenario.seed = static_cast<std::uint64_t>(seed);
  std::string world;
  config.require("world", world);
  scenario.world = config.folder() / world;
  config.read("ground_models", scenario.ground_models);
  read_vehicle(config.child("vehicle"), scenario.vehicle);
  read_start(config.child("start"), scenario.start);
  read_wind(config.child("wind"), scenario.wind);
  read_sensors(config.child("sensors"), scenario.sensors);
  read_mission(config.child("mission"), scenario.mission);
  read_obstacles(config, scenario.obstacles);
  read_pushes(config, scenario.pushes);
  if (config.has("claw")) read_claw(config.child("claw"), scenario.claw.emplace());
  config.read("time_limit_s", scenario.time_limit_s, kPositive);
  read_map(config.child("map"), scenario.map);
  config.finish();
  std::error_code ignored;  // such as a name that is too long
  if (!std::filesystem::is_regular_file(scenario.world, ignored)) {
    config.fail("world", fmt::format("world file '{}' is not there; the path is relative to the "
                                     "folder of the scenario",
                                     scenario.world.lexically_normal().string()));
  }
  return scenario;
}

std::vector<std::string> components_of(const Scenario& scenario) {
  std::vector<std::string> names{"sim",     "estimator", "flight_controller", "lidar_mapper",
                                 "planner", "guard",     "commander"};
  if (scenario.mission.explore) names.emplace_back("explorer");
  if (scenario.claw) names.insert(names.end(), {"sim_claw", "claw"});
  return names;
}

}  // namespace swiftlet
