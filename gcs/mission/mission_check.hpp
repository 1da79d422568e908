// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/flight_director.hpp"
#include "gcs/mission/mission_file.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

struct MissionFinding {
  enum class Severity {
    kError,    ///< it cannot be flown as it is
    kWarning,  ///< it can; who sends it should know
  };
  /// What it is about.
  enum class About { kItem, kOrder, kDistance, kFence, kZone, kSpeed, kObstacle, kBattery, kSize };
  Severity severity = Severity::kError;
  About about = About::kItem;
  std::size_t item = 0;  ///< from 1; 0 where it is about the mission as a whole
  int line = 0;          ///< of the item in its file; 0 where it has none
  std::string text;      ///< a sentence with numbers and a remedy
};

/// What is known of the vehicle and of where it flies. Whatever is not given is not checked.
struct MissionCheckParams {
  bool on_ground = true;                              ///< so that it begins with a take-off
  Eigen::Vector3d takeoff = Eigen::Vector3d::Zero();  ///< where it stands or stood, in the map [m]
  /// Where it is in the map, in flight [m]. Without, the way to the first waypoint is not checked.
  std::optional<Eigen::Vector3d> start{};
  std::optional<LocalOrigin> origin;  ///< else from the mission's home
  Geofence fence;                     ///< around the take-off point
  std::size_t most_items = 1000;      ///< that the vehicle takes
  std::optional<double> most_speed;   ///< [m/s]
  std::optional<double> flown_speed;  ///< what is faster is flown at that [m/s]
  double longest_leg = 1000.0;        ///< a longer one is a mistake [m]

  const OccupancyGrid* map = nullptr;  ///< of its band of heights; where obstacles are known
  double clearance = 0.35;             ///< from the vehicle's centre to an obstacle [m]

  // As the commander and the planner fly.
  double gps_altitude = 15.24;  ///< of waypoints on Earth that have none [m]
  double gps_speed = 3.0;       ///< and their speed [m/s]
  double indoor_speed = 1.0;    ///< in the map [m/s]
  double climb_speed = 0.8;     ///< [m/s]
  double descent_speed = 0.4;   ///< of a landing [m/s]
  double acceleration = 1.5;    ///< it stops at every waypoint [m/s^2]
  double claw_time = 2.0;       ///< to open or to close [s]

  std::optional<double> endurance;  ///< of a full battery in the air [s]
  double charge = 1.0;              ///< of it at take-off [0..1]
  double reserve = 0.2;             ///< to be down with [0..1]
};

struct MissionCheck {
  std::vector<MissionFinding> findings;  ///< by item, the whole mission's last
  double length = 0.0;                   ///< of all legs whose ends are known in the same frame [m]
  double duration = 0.0;                 ///< with climbs, holds, the way back and the landing [s]

  bool has_errors() const;
};

/// Looks at a mission as a whole, before it is sent. The same mission and parameters give the same
/// findings in the same order.
///
/// A leg climbs or sinks to the height of its end first, and is level then. To a place on Earth it
/// is straight, and must be clear of obstacles that the map knows at its height; to a place in the
/// map the planner finds a way, and the end alone must be clear.
MissionCheck check_mission(const MissionFile& mission, const MissionCheckParams& params);

/// The same of a mission in place of another: errors that the other had are none of who changes
/// something else, and are warnings. Each of them forgives one: the same, or else one that is about
/// the same, since their numbers change with the mission.
MissionCheck check_change(const MissionFile& before, const MissionFile& after,
                          const MissionCheckParams& params);

/// "office.yaml:12: item 3: error: ...", a line.
std::string describe(const MissionFinding& finding, const std::string& file);

}  // namespace swiftlet
