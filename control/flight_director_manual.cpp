// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of FlightDirector that a person steers: Manual and Assisted Manual, and how sticks take
// over from other modes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "control/flight_director.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// A steered piece is flown for so long where no other follows: two and a half ticks.
constexpr Duration kSteeredPiece = 25ms;
/// A way that ends is gone with speeds that these bring to rest at its end.
constexpr double kWayGain = 1.2;   // [1/s]
constexpr double kWayBrake = 0.6;  // [m/s^2]
/// A brake is looked at in steps of [s].
constexpr double kBrakeStep = 0.02;
/// What it may be nearer than is set, and still begin [m].
constexpr double kDistanceSlack = 0.02;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double speed_for(double way) {
  return way < kInfinity ? easing(std::max(way, 0.0), kWayGain, kWayBrake) : way;
}

}  // namespace

void FlightDirector::set_sticks(const Sticks& sticks, Time time) {
  if (!std::isfinite(sticks.deflection())) return;  // silence will tell
  sticks_ = sticks;
  sticks_heard_ = time;
}

void FlightDirector::set_obstacles(NearObstacles obstacles, Time time) {
  obstacles_ = std::move(obstacles);
  obstacles_seen_ = time;
}

std::string FlightDirector::sticks_problem(Time now) const {
  if (!sticks_heard_) return "no remote control was heard; is it on?";
  const double age = to_seconds(now - *sticks_heard_);
  if (std::abs(age) <= params_.sticks_timeout) return "";
  return fmt::format("the remote control has been silent for {:.1f} s", age);
}

std::string FlightDirector::obstacles_problem(Time now) const {
  if (!obstacles_seen_) return "nothing was seen around; is the LIDAR running?";
  const double age = to_seconds(now - *obstacles_seen_);
  if (std::abs(age) <= params_.obstacles_timeout) return "";
  return fmt::format("the LIDAR has seen nothing for {:.1f} s", age);
}

/// Sticks that are moved take over from whatever flies.
void FlightDirector::heed_sticks(Time now) {
  const Mode mode = machine_.mode();
  if (mode == Mode::kGrounded || is_steered() || !sticks_problem(now).empty()) return;
  // Who was stopped by the guard lets the sticks go, and steers again then.
  if (guard_acting_) must_release_ = true;
  if (sticks_.deflection() < params_.takeover) must_release_ = false;
  if (guard_acting_ || must_release_) return;
  if (sticks_.deflection() < params_.takeover) return;
  const Situation seen = situation(now);
  const auto taken =
      machine_.request(sticks_.assisted ? Request::assist() : Request::manual(), seen);
  if (taken.ok()) {
    flying_.last_reason = "the remote control takes over";
    enter(machine_.mode(), now);
    return;
  }
  flying_.last_reason = taken.error().reason;
  // Somebody wants it to do something else: then it shall at least not go on.
  if (mode != Mode::kHover && mode != Mode::kLand &&
      machine_.request(Request::hover(), seen).ok()) {
    enter(machine_.mode(), now);
  }
}

bool FlightDirector::is_steered() const {
  return machine_.mode() == Mode::kManual || machine_.mode() == Mode::kAssistedManual;
}

void FlightDirector::follow_sticks(Time now) {
  // A successor may not have heard them yet.
  const bool silent = !sticks_heard_ || to_seconds(now - *sticks_heard_) > params_.sticks_period;
  // What is flown comes to rest by itself, and stays there.
  if (silent || sticks_.deflection() <= params_.steering.dead_band) return;
  const FlatReference from = reference(now);
  const Steering wanted = allowed(swiftlet::steering(sticks_, from.yaw, params_.steering), now);
  Trajectory candidate = steer(now, kSteeredPiece, from, wanted, params_.steering, params_.braking);
  if (candidate.empty()) return;
  if (!stays_clear(candidate)) return;
  flying_.simple = std::move(candidate);
}

/// As much of what sticks ask for as the room around leaves: floor, ceiling, fence, and obstacles
/// for who is assisted. The direction is kept: who is stopped does not slide along the wall, and
/// who is too near and pushes on goes back to the distance that is set.
Steering FlightDirector::allowed(Steering wanted, Time now) const {
  const FlatReference at = reference(now);
  double& climb = wanted.velocity.z();
  const double height = at.position.z() - flying_.takeoff_point.z();
  double ceiling = params_.modes.max_altitude;
  if (params_.fence.height > 0.0) ceiling = std::min(ceiling, params_.fence.height);
  const double above_floor = std::min(height, range_down_.value_or(height)) - params_.lowest_range;
  climb = std::clamp(climb, -speed_for(above_floor), speed_for(ceiling - height));

  const double speed = wanted.velocity.head<2>().norm();
  if (speed == 0.0) return wanted;
  const Eigen::Vector2d place = at.position.head<2>();
  const Eigen::Vector2d direction = wanted.velocity.head<2>() / speed;
  double way = way_to_fence(place, direction);
  if (machine_.mode() == Mode::kAssistedManual) {
    const double radius = params_.vehicle_radius + params_.obstacle_distance;
    const double free = obstacles_.free_way(place, direction, radius);
    if (free <= 0.0) {
      // Nearer than is set, be it that the estimate drifted or that somebody came: back to there.
      const Eigen::Vector2d from_obstacle = place - *obstacles_.nearest(place);
      const double distance = from_obstacle.norm();
      wanted.velocity.head<2>() = Eigen::Vector2d::Zero();
      if (distance > 0.0) {
        wanted.velocity.head<2>() = from_obstacle * (speed_for(radius - distance) / distance);
      }
      return wanted;
    }
    way = std::min(way, free);
  }
  wanted.velocity.head<2>() = direction * std::min(speed, speed_for(way));
  return wanted;
}

/// Whether a steered piece and the brake after it stay within the fence and, for who is assisted,
/// away from obstacles; or come no farther and no nearer than it is already.
bool FlightDirector::stays_clear(const Trajectory& candidate) const {
  const bool assisted = machine_.mode() == Mode::kAssistedManual;
  const auto clearance = [&](const Eigen::Vector2d& place) {
    return assisted ? obstacles_.clearance(place) : kInfinity;
  };
  const auto from_home = [this](const Eigen::Vector2d& place) {
    return (place - flying_.takeoff_point.head<2>()).norm();
  };
  const Eigen::Vector2d begin = candidate.evaluate(candidate.start()).position.head<2>();
  const double set = params_.vehicle_radius + params_.obstacle_distance - kDistanceSlack;
  const double least = std::min(set, clearance(begin));
  const double fence = params_.fence.radius > 0.0 ? params_.fence.radius : kInfinity;
  const double most = std::max(fence, from_home(begin));
  const double duration = to_seconds(candidate.duration());
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / kBrakeStep)));
  for (int i = 1; i <= steps; ++i) {
    const Time time = candidate.start() + from_seconds(duration * i / steps);
    const Eigen::Vector2d place = candidate.evaluate(time).position.head<2>();
    if (clearance(place) < least || from_home(place) > most) return false;
  }
  return true;
}

}  // namespace swiftlet
