// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/geodesy/local_origin.hpp"

namespace swiftlet {

/// A place to fly to.
struct MissionWaypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  std::optional<double> yaw{};                         ///< [rad]; without, the heading is kept
  std::optional<double> speed{};  ///< the greatest in GPS Guidance; without, the usual one [m/s]
};

/// A place on Earth (WGS84) to fly to.
struct GlobalWaypoint {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double altitude = 0.0;   ///< above the take-off point; 0: the usual one of GPS Guidance [m]
};

/// Where that is in the map: `usual_altitude` [m] is flown at where it has none of its own,
/// `home_z` [m] is the take-off point. An error where it is no place on Earth.
Result<Eigen::Vector3d> place_of(const GlobalWaypoint& waypoint, const LocalOrigin& origin,
                                 double usual_altitude, double home_z);

/// One step of a mission.
struct MissionItem {
  enum class Kind {
    kTakeoff,   ///< climb to `altitude`, where the vehicle is not in the air already
    kWaypoint,  ///< fly to `global`, in straight lines, or to `place`, around obstacles; then hold
    kHold,      ///< hover for `hold`
    kLand,      ///< where it is
    kReturn,    ///< to the take-off point, straight from a waypoint on Earth, and land
    kClaw,      ///< `open` it, or close it
  };
  Kind kind = Kind::kWaypoint;
  MissionWaypoint place;                 ///< in the map; of one on Earth only yaw and speed
  std::optional<GlobalWaypoint> global;  ///< then the waypoint is here
  double hold = 0.0;                     ///< [s]
  double altitude = 0.0;                 ///< above the take-off point [m]
  bool open = false;
};

/// Why an item makes no sense, wherever it is flown: "hold is -1 s"; "" where it does.
std::string problem_of(const MissionItem& item);

}  // namespace swiftlet
