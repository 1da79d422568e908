// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

/// The longest step that integrators believe in [s].
constexpr double kMaxStep = 0.05;
/// Stamps may run ahead of the IMU's by what a busy machine delays samples; beyond, they are of
/// another clock [s].
constexpr double kMaxAhead = 0.2;

bool finite(const FlatReference& reference) {
  return reference.position.allFinite() && reference.velocity.allFinite() &&
         reference.acceleration.allFinite() && reference.jerk.allFinite() &&
         reference.snap.allFinite() && std::isfinite(reference.yaw) &&
         std::isfinite(reference.yaw_rate) && std::isfinite(reference.yaw_acceleration);
}

}  // namespace

FlatReference extrapolate(const FlatReference& reference, double dt) {
  FlatReference later = reference;
  const double dt2 = dt * dt / 2.0;
  const double dt3 = dt2 * dt / 3.0;
  const double dt4 = dt3 * dt / 4.0;
  later.position += reference.velocity * dt + reference.acceleration * dt2 + reference.jerk * dt3 +
                    reference.snap * dt4;
  later.velocity += reference.acceleration * dt + reference.jerk * dt2 + reference.snap * dt3;
  later.acceleration += reference.jerk * dt + reference.snap * dt2;
  later.jerk += reference.snap * dt;
  later.yaw += reference.yaw_rate * dt + reference.yaw_acceleration * dt2;
  later.yaw_rate += reference.yaw_acceleration * dt;
  return later;
}

FlightLoop::FlightLoop(const Params& params, const QuadrotorModel& model)
    : params_(params), controller_(params.controller, model), mixer_(model) {
  const bool fine = params.setpoint_timeout > 0.0 && params.setpoint_timeout <= 1.0 &&
                    params.estimate_timeout > 0.0 && params.estimate_timeout <= 1.0 &&
                    params.sinking_thrust_to_weight > 0.0 && params.sinking_thrust_to_weight <= 1.0;
  if (!fine) {
    throw std::invalid_argument(
        "flight loop: timeouts must be above 0 and at most 1 s, sinking_thrust_to_weight above 0 "
        "and at most 1");
  }
}

bool FlightLoop::Freshness::within(double timeout, Time now) const {
  if (!stamp || !heard) return false;
  const double age = to_seconds(now - *stamp);
  return age >= -kMaxAhead && age <= timeout && to_seconds(now - *heard) <= timeout;
}

void FlightLoop::set_estimate(Time time, const RigidBodyState& state) {
  const bool usable = state.p_WB.allFinite() && state.v_WB_W.allFinite() &&
                      std::abs(state.q_WB.norm() - 1.0) < 1e-3;
  if (!usable) return;
  estimate_freshness_ = {time, std::nullopt};
  attitude_time_ = time;
  const Eigen::Vector3d angular_velocity = state_.w_WB_B;
  state_ = state;
  state_.w_WB_B = angular_velocity;  // the gyroscope's is newer
}

void FlightLoop::set_setpoint(const FlightSetpoint& setpoint) {
  if (setpoint.kind == SetpointKind::kTrack && !finite(setpoint.reference)) return;
  setpoint_ = setpoint;
  setpoint_freshness_ = {setpoint.time, std::nullopt};
}

void FlightLoop::carry_attitude(Time now) {
  const double dt = attitude_time_ ? to_seconds(now - *attitude_time_) : 0.0;
  if (dt > 0.0) {
    state_.q_WB = (state_.q_WB * exp_so3(state_.w_WB_B * std::min(dt, kMaxStep))).normalized();
  }
  // An estimate that is a little ahead is waited for.
  if (!attitude_time_ || dt > 0.0 || dt < -kMaxAhead) attitude_time_ = now;
}

FlightLoop::Output FlightLoop::step(Time now, const Eigen::Vector3d& angular_velocity) {
  const double dt = last_step_ ? std::clamp(to_seconds(now - *last_step_), 0.0, kMaxStep) : 0.0;
  last_step_ = now;
  if (angular_velocity.allFinite()) state_.w_WB_B = angular_velocity;
  carry_attitude(now);
  for (Freshness* freshness : {&setpoint_freshness_, &estimate_freshness_}) {
    if (!freshness->heard) freshness->heard = now;
  }

  if (setpoint_.kind == SetpointKind::kMotorsOff) {
    integral_ = {};
    return {};
  }
  if (!estimate_freshness_.within(params_.estimate_timeout, now)) {
    return level(Behaviour::kStaleEstimate, params_.sinking_thrust_to_weight);
  }
  if (!setpoint_freshness_.within(params_.setpoint_timeout, now)) {
    return level(Behaviour::kStaleSetpoint, 1.0);
  }
  if (setpoint_.kind == SetpointKind::kLevel) {
    return level(Behaviour::kLevel, params_.sinking_thrust_to_weight);
  }
  return track(now, dt);
}

FlightLoop::Output FlightLoop::track(Time now, double dt) {
  Output output;
  output.behaviour = Behaviour::kTracking;
  const FlatReference reference =
      extrapolate(setpoint_.reference, to_seconds(now - setpoint_.time));
  output.tracking = controller_.compute(state_, reference, integral_);
  integral_ = controller_.integrate(integral_, output.tracking, dt);
  output.mixer = mixer_.mix(output.tracking.wrench);
  output.rotor_thrusts = output.mixer.rotor_thrusts;
  return output;
}

FlightLoop::Output FlightLoop::level(Behaviour behaviour, double thrust_to_weight) const {
  Output output;
  output.behaviour = behaviour;
  output.mixer = mixer_.mix(controller_.level(state_, thrust_to_weight));
  output.rotor_thrusts = output.mixer.rotor_thrusts;
  return output;
}

}  // namespace swiftlet
