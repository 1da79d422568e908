// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "control/mission_runner.hpp"
#include "estimation/battery/battery_clock.hpp"
#include "estimation/geodesy/global_fix.hpp"
#include "estimation/geometry/rigid_body.hpp"

/// What a vehicle says of itself, beside RigidBodyState, BatteryReport and GlobalFix.
namespace swiftlet::screen {

/// What the vehicle says of itself ten times a second.
struct VehicleReport {
  std::string mode;
  bool in_flight = false;
  bool navigates = false;  ///< along a path
  bool armed = false;
  bool ready = false;      ///< may be armed
  std::string reason;      ///< of the last change of mode, or why not ready
  double height = 0.0;     ///< above the take-off point [m]
  int waypoint = 0;        ///< that is flown to, from 1; 0 without a mission
  int waypoint_count = 0;  ///<
  bool mission_done = false;
  std::optional<Eigen::Vector3d> takeoff_point{};  ///< in the map [m]
  std::string station{};                           ///< that has control; "" where none has
};

/// The mission that the vehicle has.
struct MissionReport {
  using State = MissionRunner::State;
  State state = State::kNone;
  int item = 0;           ///< that is flown or was, from 1; 0 where none is
  int count = 0;          ///< of items
  std::string reason{};   ///< of kPaused
  std::string id{};       ///< of its upload
  std::string refusal{};  ///< why an upload was refused; "" where none was
  std::string upload{};   ///< identity of the last upload, refused or not
};

/// "mission paused at item 3: manual control".
std::string describe_pause(const MissionReport& report);

/// What flights are held to. 0: there is none, or it is not known.
struct LimitsReport {
  Geofence fence;
  double gps_altitude = 0.0;   ///< of waypoints on Earth that have none [m]
  double gps_speed = 0.0;      ///< the greatest in GPS Guidance [m/s]
  double climb_speed = 0.0;    ///< [m/s]
  double descent_speed = 0.0;  ///< of a landing [m/s]
  double clearance = 0.0;      ///< of waypoints, from the centre of the vehicle [m]
  double low_battery = 0.0;    ///< charge at which a flight is ended [0..1]
  double endurance = 0.0;      ///< of a full battery in the air [s]
  std::size_t most_items = 0;  ///< of a mission
};

/// What the vehicle carries with.
struct ClawReport {
  std::string state;  ///< in a word
  std::string fault;  ///< why it does not do as it is told; "" where it does
};

struct GuardReport {
  bool acting = false;
  std::string reason;
};

struct ComponentReport {
  std::vector<std::string> problems;
};

/// A topic's share of the radio link.
struct TopicShare {
  std::string topic;
  double bytes_per_s = 0.0;
  bool thinned = false;  ///< for want of budget
};
struct LinkReport {
  double bytes_per_s = 0.0;
  double budget_bytes_per_s = 0.0;
  std::vector<TopicShare> topics;
};

/// All of it in one, over a link that carries little. What is not known is not there.
struct TelemetryReport {
  enum class Health { kWell, kWarned, kError, kUnknown };
  std::optional<VehicleReport> vehicle{};  ///< without a take-off point
  std::optional<RigidBodyState> pose{};
  std::optional<BatteryReport> battery{};
  std::optional<double> battery_seconds_left{};
  std::optional<GlobalFix> fix{};
  MissionReport mission{};  ///< kReady may be kDone
  std::optional<ClawReport> claw{};
  GuardReport guard{};
  Health health = Health::kUnknown;  ///< the worst of all on board
};

}  // namespace swiftlet::screen
