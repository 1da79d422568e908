// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of FlightDirector that flies straight lines: GPS Guidance.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/flight_director.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// A leg is flown where it is longer than this [m].
constexpr double kShortestLeg = 0.02;
/// Room that is left between the end of a brake and an obstacle, beside the vehicle's radius [m].
constexpr double kStopMargin = 0.30;

}  // namespace

Result<Acceptance> FlightDirector::fly_straight(std::uint64_t id,
                                                const std::vector<MissionWaypoint>& waypoints,
                                                Time now, std::size_t first_number) {
  return begin(Request::gps(id, mission_problem(waypoints, first_number,
                                                std::numeric_limits<double>::infinity())),
               waypoints, now, first_number);
}

/// At first to the height of the leg's end, then straight there. What the LIDAR sees on the way
/// ends it.
void FlightDirector::follow_legs(Time now) {
  if (flying_.navigation != Navigation::kActive) return;
  const std::string target =
      machine_.returning() ? "the take-off point"
                           : fmt::format("waypoint {}", flying_.first_number + flying_.waypoint);
  if (obstacles_seen_ && !obstacles_problem(now).empty()) {
    return fail_navigation(obstacles_problem(now));
  }
  const FlatReference flown = reference(now);
  if (const double speed = flown.velocity.head<2>().norm(); speed > 0.0) {
    const Eigen::Vector2d place = flown.position.head<2>();
    const double way = obstacles_.free_way(place, flown.velocity.head<2>() / speed,
                                           params_.vehicle_radius + kStopMargin);
    const auto brake = FlightReference::brake(now, flown, params_.braking);
    if (brake.ok() && (brake->final().position.head<2>() - place).norm() >= way) {
      return fail_navigation(
          fmt::format("an obstacle {:.1f} m ahead on the way to {}", way, target));
    }
  }
  if (now < flying_.simple.end()) return;

  const FlatReference rest = flying_.simple.final_reference();
  const Eigen::Vector3d& goal = flying_.waypoints[flying_.waypoint].position;
  Eigen::Vector3d next = rest.position;
  next.z() = goal.z();
  const bool at_height = std::abs(next.z() - rest.position.z()) <= kShortestLeg;
  if (at_height) next = goal;
  if ((next - rest.position).norm() > kShortestLeg) {
    ReferenceLimits limits = at_height ? params_.cruise : params_.takeoff;
    const std::optional<double>& speed = flying_.waypoints[flying_.waypoint].speed;
    limits.velocity = std::min(limits.velocity, speed.value_or(limits.velocity));
    const auto leg = FlightReference::move(now, rest.position, next, rest.yaw, limits);
    if (!leg.ok()) return fail_navigation(fmt::format("no line to {}", target));
    flying_.simple = leg->trajectory();
    return;
  }
  if (!arrived(goal)) {
    if (to_seconds(now - flying_.simple.end()) > params_.arrival_timeout) {
      fail_navigation(
          fmt::format("{} was missed by {:.2f} m", target, (goal - state_.p_WB).norm()));
    }
    return;
  }
  next_waypoint();
}

}  // namespace swiftlet
