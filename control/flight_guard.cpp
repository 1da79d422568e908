// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

/// From a setpoint to the vehicle that brakes [s].
constexpr double kReaction = 0.05;
/// A last setpoint that is older is no beginning for a brake [s].
constexpr double kRecent = 0.05;
/// A vehicle that hovers is not faster [m/s].
constexpr double kDrift = 0.1;
constexpr int kBrakeSamples = 16;

bool is_finite(const FlatReference& r) {
  return r.position.allFinite() && r.velocity.allFinite() && r.acceleration.allFinite() &&
         r.jerk.allFinite() && r.snap.allFinite() && std::isfinite(r.yaw) &&
         std::isfinite(r.yaw_rate) && std::isfinite(r.yaw_acceleration);
}

}  // namespace

FlightGuard::FlightGuard(const Params& params) : params_(params) {
  const std::initializer_list<double> positive{
      params.vehicle_radius,   params.max_speed,     params.max_gap,     params.obstacles_timeout,
      params.release_distance, params.release_speed, params.release_time};
  const bool fine = std::all_of(positive.begin(), positive.end(),
                                [](double v) { return v > 0.0 && std::isfinite(v); }) &&
                    params.margin >= 0.0 && params.fence_radius >= 0.0 &&
                    params.fence_height >= 0.0 &&
                    FlightReference::brake(Time{}, {}, params.braking).ok();
  if (!fine) {
    throw std::invalid_argument(
        "flight guard: distances, speeds and times must be positive and finite, margin and fence "
        "not negative");
  }
}

void FlightGuard::set_obstacles(NearObstacles obstacles, Time time) {
  obstacles_ = std::move(obstacles);
  obstacles_seen_ = time;
}

std::optional<FlightSetpoint> FlightGuard::check(const FlightSetpoint& setpoint) {
  if (setpoint.kind != SetpointKind::kTrack || !state_) {
    holding_.reset();
    last_sound_.reset();
    return std::nullopt;
  }
  if (holding_ && may_release(setpoint)) holding_.reset();
  if (!holding_) {
    std::string found = problem(setpoint);
    if (found.empty()) {
      last_sound_ = setpoint;
      return std::nullopt;
    }
    reason_ = std::move(found);
    stop(setpoint);
  }
  return FlightSetpoint{setpoint.time, SetpointKind::kTrack, holding_->evaluate(setpoint.time)};
}

/// What is wrong with a setpoint; "" where nothing is.
std::string FlightGuard::problem(const FlightSetpoint& setpoint) const {
  const FlatReference& r = setpoint.reference;
  if (!is_finite(r)) return "the setpoint is no number";
  if (const double speed = r.velocity.norm(); speed > params_.max_speed) {
    return fmt::format("the setpoint is for {:.1f} m/s", speed);
  }
  if (const double gap = (r.position - state_->p_WB).norm(); gap > params_.max_gap) {
    return fmt::format("the setpoint is {:.1f} m away", gap);
  }
  const auto brake = brake_from_now(setpoint);
  if (!brake) return "";
  const std::string outside = breach(setpoint, *brake);
  return outside.empty() ? collision(setpoint, *brake) : outside;
}

std::optional<FlightReference> FlightGuard::brake_from_now(const FlightSetpoint& setpoint) const {
  FlatReference from = setpoint.reference;
  from.position = state_->p_WB + kReaction * state_->v_WB_W;
  from.velocity = state_->v_WB_W;
  const auto brake = FlightReference::brake(setpoint.time, from, params_.braking);
  return brake.ok() ? std::optional<FlightReference>(*brake) : std::nullopt;
}

/// Whether it ends outside of the fence, and the setpoint or the vehicle leads farther out.
std::string FlightGuard::breach(const FlightSetpoint& setpoint,
                                const FlightReference& brake) const {
  if (!home_) return "";
  const Eigen::Vector3d place = setpoint.reference.position - *home_;
  const Eigen::Vector3d& velocity = setpoint.reference.velocity;
  const Eigen::Vector3d end = brake.at(brake.end()).position - *home_;
  const double radius = params_.fence_radius, height = params_.fence_height;
  const Eigen::Vector2d out = place.head<2>().normalized();
  const bool goes_out =
      velocity.head<2>().dot(out) > 0.0 ||
      (place.head<2>().norm() > radius && state_->v_WB_W.head<2>().dot(out) > kDrift);
  if (const double beyond = end.head<2>().norm() - radius;
      radius > 0.0 && beyond > 0.0 && goes_out) {
    return fmt::format("a stop now would end {:.2f} m outside of the fence", beyond);
  }
  const bool goes_up = velocity.z() > 0.0 || (place.z() > height && state_->v_WB_W.z() > kDrift);
  if (const double above = end.z() - height; height > 0.0 && above > 0.0 && goes_up) {
    return fmt::format("a stop now would end {:.2f} m above the fence", above);
  }
  return "";
}

/// Whether it ends too near to something that was seen.
std::string FlightGuard::collision(const FlightSetpoint& setpoint,
                                   const FlightReference& brake) const {
  if (!obstacles_seen_) return "";
  if (std::abs(to_seconds(setpoint.time - *obstacles_seen_)) > params_.obstacles_timeout) return "";
  const double least = params_.vehicle_radius + params_.margin;
  const double now = obstacles_.clearance(state_->p_WB.head<2>());
  double clearance = now;
  const double duration = to_seconds(brake.end() - brake.start());
  for (int i = 1; i <= kBrakeSamples; ++i) {
    const Time time = brake.start() + from_seconds(duration * i / kBrakeSamples);
    clearance = std::min(clearance, obstacles_.clearance(brake.at(time).position.head<2>()));
  }
  // Who is too near already may go away.
  if (clearance >= least || clearance >= now) return "";
  return fmt::format("{:.2f} m to what the LIDAR sees, and no room to stop later",
                     now - params_.vehicle_radius);
}

/// From what was flown until now, or, where that cannot be trusted, from how the vehicle moves.
void FlightGuard::stop(const FlightSetpoint& setpoint) {
  FlatReference from;
  from.position = state_->p_WB;
  from.velocity = state_->v_WB_W;
  from.yaw = yaw_of(state_->q_WB);
  if (last_sound_ && std::abs(to_seconds(setpoint.time - last_sound_->time)) < kRecent) {
    from = extrapolate(last_sound_->reference, to_seconds(setpoint.time - last_sound_->time));
  }
  auto brake = FlightReference::brake(setpoint.time, from, params_.braking);
  if (!brake.ok()) brake = FlightReference::hold(state_->p_WB, yaw_of(state_->q_WB));
  holding_ = brake.ok() ? brake->trajectory() : Trajectory();
  obedient_since_.reset();
}

/// The commander has stopped, too, where the guard holds.
bool FlightGuard::may_release(const FlightSetpoint& setpoint) {
  const FlatReference& r = setpoint.reference;
  const bool obeys =
      is_finite(r) && setpoint.time >= holding_->end() &&
      r.velocity.norm() <= params_.release_speed &&
      (r.position - holding_->final_reference().position).norm() <= params_.release_distance;
  if (!obeys) {
    obedient_since_.reset();
    return false;
  }
  if (!obedient_since_) obedient_since_ = setpoint.time;
  return to_seconds(setpoint.time - *obedient_since_) >= params_.release_time;
}

}  // namespace swiftlet
