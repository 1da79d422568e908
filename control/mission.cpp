// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mission.hpp"

#include <fmt/format.h>

#include <cmath>

namespace swiftlet {
namespace {

/// Farther than anything that is flown to indoors [m].
constexpr double kFarthest = 1e4;
/// Longer than a battery lasts [s].
constexpr double kLongestHold = 3600.0;
/// Faster than a small multirotor [m/s].
constexpr double kFastest = 50.0;

bool is_from(double value, double least, double most) {
  return value >= least && value <= most;  // no NaN
}

std::string problem_of_waypoint(const MissionItem& item) {
  if (item.global) {
    const GlobalWaypoint& global = *item.global;
    if (!GlobalPosition{global.latitude, global.longitude, 0.0}.usable()) {
      return fmt::format("{}, {} is no place on Earth", global.latitude, global.longitude);
    }
    if (!is_from(global.altitude, 0.0, kFarthest)) {
      return fmt::format("an altitude of {} m cannot be flown", global.altitude);
    }
  } else if (!item.place.position.allFinite() ||
             item.place.position.cwiseAbs().maxCoeff() >= kFarthest) {
    return "it is not a place that can be flown to";
  }
  if (!std::isfinite(item.place.yaw.value_or(0.0))) return "its yaw is no number";
  if (!item.place.speed) return "";
  if (!item.global) return "only a waypoint on Earth has a speed of its own";
  if (!is_from(*item.place.speed, 0.1, kFastest)) {
    return fmt::format("a speed of {} m/s cannot be flown", *item.place.speed);
  }
  return "";
}

}  // namespace

Result<Eigen::Vector3d> place_of(const GlobalWaypoint& waypoint, const LocalOrigin& origin,
                                 double usual_altitude, double home_z) {
  const GlobalPosition place{waypoint.latitude, waypoint.longitude, origin.position().altitude};
  if (!place.usable() || !is_from(waypoint.altitude, 0.0, kFarthest)) {
    return Error{"no place on Earth"};
  }
  Eigen::Vector3d position = origin.to_map(place);
  position.z() = home_z + (waypoint.altitude > 0.0 ? waypoint.altitude : usual_altitude);
  return position;
}

std::string problem_of(const MissionItem& item) {
  using Kind = MissionItem::Kind;
  const bool holds = item.kind == Kind::kWaypoint || item.kind == Kind::kHold;
  if (holds && !is_from(item.hold, 0.0, kLongestHold)) {
    return fmt::format("a hold of {} s cannot be flown", item.hold);
  }
  if (item.kind == Kind::kTakeoff && !is_from(item.altitude, 0.0, kFarthest)) {
    return fmt::format("an altitude of {} m cannot be flown", item.altitude);
  }
  return item.kind == Kind::kWaypoint ? problem_of_waypoint(item) : "";
}

}  // namespace swiftlet
