// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gcs/mission/mission_check.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

namespace swiftlet::screen {

/// What keys depend on.
struct Circumstances {
  Time now{};
  bool in_flight = false;
  bool mission_flies = false;                ///< that the vehicle has
  bool mission_done = false;                 ///< all of it, and it has no other
  bool has_control = false;                  ///< this ground station
  std::optional<Eigen::Vector3d> vehicle{};  ///< in the map [m]
  std::vector<std::string> components{};     ///< that have parameters
  MissionCheckParams check{};                ///< of a mission that is to be flown now; without map
  std::shared_ptr<const GridMap> map{};      ///< null while none is known, or it is coarse
  std::vector<std::string> unknown{};        ///< what cannot be checked therefore: "the fence"
};

Circumstances circumstances_of(const GroundStationModel& model, Time now);

/// A map as obstacles are looked for in it; that takes tens of milliseconds for a large one.
OccupancyGrid known_map(const GridMap& map);

}  // namespace swiftlet::screen
