// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/circumstances.hpp"

namespace swiftlet::screen {
namespace {

void take(const LimitsReport& limits, MissionCheckParams& check) {
  check.fence = limits.fence;
  check.reserve = limits.low_battery;
  const auto take_known = [](double value, double& into) {
    if (value > 0.0) into = value;
  };
  take_known(limits.gps_altitude, check.gps_altitude);
  take_known(limits.gps_speed, check.gps_speed);
  take_known(limits.climb_speed, check.climb_speed);
  take_known(limits.descent_speed, check.descent_speed);
  take_known(limits.radius, check.clearance);
  if (limits.gps_speed > 0.0) check.most_speed = limits.gps_speed;
  if (limits.endurance > 0.0) check.endurance = limits.endurance;
  if (limits.most_items > 0) check.most_items = limits.most_items;
}

}  // namespace

Circumstances circumstances_of(const GroundStationModel& model, Time now) {
  Circumstances circumstances;
  circumstances.now = now;
  const auto& vehicle = model.vehicle();
  circumstances.in_flight = vehicle.known() && vehicle->in_flight;
  circumstances.mission_flies = model.mission_flies();
  if (model.pose().known() && model.pose()->p_WB.allFinite()) {
    circumstances.vehicle = model.pose()->p_WB;
  }
  for (const auto& [name, heard] : model.components()) circumstances.components.push_back(name);
  MissionCheckParams& check = circumstances.check;
  // Where that is not known, the vehicle refuses what it cannot fly.
  check.on_ground = vehicle.fresh(now) && !vehicle->in_flight;
  if (circumstances.in_flight) {
    if (vehicle->takeoff_point) check.takeoff.head<2>() = *vehicle->takeoff_point;
  } else if (circumstances.vehicle) {
    check.takeoff = *circumstances.vehicle;
  }
  check.origin = model.origin();
  if (model.limits().known()) take(*model.limits(), check);
  if (model.battery().known()) check.charge = model.battery()->percentage;
  circumstances.map = model.map();
  return circumstances;
}

OccupancyGrid known_map(const GridMap& map) {
  OccupancyGrid::Params params;
  params.resolution = map.resolution;
  if (!map.usable()) return OccupancyGrid(params);
  OccupancyGrid grid(params, map.origin, map.width, map.height);
  std::size_t index = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::int8_t percent = map.cells[index++];
      if (percent >= 0) grid.set_probability({x, y}, percent / 100.0);
    }
  }
  return grid;
}

}  // namespace swiftlet::screen
