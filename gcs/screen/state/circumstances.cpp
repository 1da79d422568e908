// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/circumstances.hpp"

#include <cmath>

namespace swiftlet::screen {
namespace {

/// In cells that are larger an obstacle is up to a cell too large [m].
constexpr double kCoarse = 0.1;

void take(const LimitsReport& limits, MissionCheckParams& check) {
  check.reserve = limits.low_battery;
  const auto take_known = [](double value, double& into) {
    if (value > 0.0) into = value;
  };
  take_known(limits.gps_altitude, check.gps_altitude);
  take_known(limits.gps_speed, check.gps_speed);
  take_known(limits.climb_speed, check.climb_speed);
  take_known(limits.descent_speed, check.descent_speed);
  take_known(limits.clearance, check.clearance);
  if (limits.gps_speed > 0.0) check.flown_speed = limits.gps_speed;
  if (limits.most_items > 0) check.most_items = limits.most_items;
}

}  // namespace

Circumstances circumstances_of(const GroundStationModel& model, Time now) {
  Circumstances circumstances;
  circumstances.now = now;
  const auto& vehicle = model.vehicle();
  circumstances.in_flight = vehicle.known() && vehicle->in_flight;
  circumstances.mission_flies = model.mission_flies();
  circumstances.mission_done =
      model.mission().known() && model.mission()->state == MissionReport::State::kDone;
  circumstances.has_control = model.has_control();
  if (model.pose().known() && model.pose()->p_WB.allFinite()) {
    circumstances.vehicle = model.pose()->p_WB;
  }
  for (const auto& [name, heard] : model.components()) circumstances.components.push_back(name);
  MissionCheckParams& check = circumstances.check;
  // Where that is not known, the vehicle refuses what it cannot fly.
  check.on_ground = vehicle.fresh(now) && !vehicle->in_flight;
  check.origin = model.origin();
  const std::optional<Eigen::Vector3d> takeoff =
      circumstances.in_flight ? vehicle->takeoff_point : circumstances.vehicle;
  if (takeoff) check.takeoff = *takeoff;
  if (circumstances.in_flight) check.start = circumstances.vehicle;

  const bool has_limits = model.limits().known();
  const bool has_charge = model.battery().known() && std::isfinite(model.battery()->percentage);
  if (has_limits) take(*model.limits(), check);
  if (has_limits && takeoff) check.fence = model.limits()->fence;
  if (has_charge) check.charge = model.battery()->percentage;
  if (has_limits && has_charge && model.limits()->endurance > 0.0) {
    check.endurance = model.limits()->endurance;
  }
  if (model.map() && model.map()->usable() && model.map()->resolution <= kCoarse) {
    circumstances.map = model.map();
  }
  std::vector<std::string>& unknown = circumstances.unknown;
  if (!takeoff) unknown.push_back("where it takes off");
  if (!has_limits) unknown.push_back("its speeds");
  if (!has_limits || !takeoff) unknown.push_back("the fence");
  if (!check.endurance) {
    unknown.push_back(has_limits && has_charge
                          ? "the battery's reach (commander.endurance is not set)"
                          : "the battery's reach");
  }
  if (!circumstances.map) unknown.push_back("obstacles");
  return circumstances;
}

OccupancyGrid known_map(const GridMap& map) {
  OccupancyGrid::Params params;
  params.resolution = map.resolution;
  OccupancyGrid grid(params, map.origin, map.width, map.height);
  grid.set_percents(map.cells);
  return grid;
}

}  // namespace swiftlet::screen
