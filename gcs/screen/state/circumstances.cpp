// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/circumstances.hpp"

namespace swiftlet::screen {

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
  return circumstances;
}

}  // namespace swiftlet::screen
