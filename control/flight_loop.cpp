// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

/// The longest step that integrators believe in [s].
constexpr double kMaxStep = 0.05;
/// Stamps may run ahead of the IMU's by what a busy machine delays samples; beyond, they are of
/// another clock [s].
constexpr double kMaxAhead = 0.2;
/// Further off the vehicle than this, the reference that was flown is not where a brake begins.
constexpr double kMaxDistance = 0.5;    // [m]
constexpr double kMaxDifference = 1.0;  // [m/s]

bool finite(const FlatReference& reference) {
  return reference.position.allFinite() && reference.velocity.allFinite() &&
         reference.acceleration.allFinite() && reference.jerk.allFinite() &&
         reference.snap.allFinite() && std::isfinite(reference.yaw) &&
         std::isfinite(reference.yaw_rate) && std::isfinite(reference.yaw_acceleration);
}

/// What the vehicle does by itself: its tilt is an acceleration that is flown already.
FlatReference at_vehicle(const RigidBodyState& state) {
  FlatReference reference;
  const Eigen::Vector3d up = state.q_WB * Eigen::Vector3d::UnitZ();
  if (up.z() > 0.5) reference.acceleration.head<2>() = up.head<2>() * (kGravity / up.z());
  reference.position = state.p_WB;
  reference.velocity = state.v_WB_W;
  reference.yaw = yaw_of(state.q_WB);
  return reference;
}

AbandonedFlight::Params abandoned_params(const FlightLoop::Params& params) {
  AbandonedFlight::Params abandoned = params.abandoned;
  abandoned.landing_speed = params.landing_speed;
  return abandoned;
}

void check(const FlightLoop::Params& params) {
  const auto within = [](double v, double most) { return v > 0.0 && v <= most; };
  const bool fine =
      within(params.setpoint_timeout, 1.0) && within(params.estimate_timeout, 1.0) &&
      params.inertial_timeout >= params.estimate_timeout && params.inertial_timeout <= 1.0 &&
      params.velocity_timeout >= params.inertial_timeout && params.velocity_timeout <= 60.0 &&
      within(params.landing_speed, 5.0) && within(params.sinking_thrust_to_weight, 1.0) &&
      within(params.ground_time, 60.0) && within(params.sonar.ground_range, 10.0) &&
      within(params.sonar.timeout, 10.0) &&
      FlightReference::move({}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.0, params.merging).ok();
  if (!fine) {
    throw std::invalid_argument(
        "flight loop: setpoint_timeout and estimate_timeout must be above 0 and at most 1 s, "
        "inertial_timeout from estimate_timeout to 1 s, velocity_timeout from inertial_timeout to "
        "60 s, landing_speed above 0 and at most 5 m/s, sinking_thrust_to_weight above 0 and at "
        "most 1, ground_time at most 60 s, ground_range and the sonar's timeout at most 10, limits "
        "of merging from 0.001 to 10000");
  }
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

bool Freshness::plausible(Time stamp, Time now, double timeout) {
  const double age = to_seconds(now - stamp);
  return age >= -kMaxAhead && age <= timeout;
}

double Freshness::age(Time now) const {
  const bool known = stamp && heard && to_seconds(now - *stamp) >= -kMaxAhead;
  if (!known) return std::numeric_limits<double>::infinity();
  return to_seconds(std::max(now - *stamp, now - *heard));
}

FlightLoop::FlightLoop(const Params& params, const QuadrotorModel& model)
    : params_(params),
      controller_(params.controller, model),
      mixer_(model),
      carry_(params.carry),
      sonar_(params.sonar),
      abandoned_(abandoned_params(params)) {
  check(params);
}

void FlightLoop::set_params(const Params& params) {
  check(params);
  const Se3Controller controller(params.controller, controller_.model());
  const AbandonedFlight usable(abandoned_params(params));
  carry_.set_params(params.carry);  // the last one that may throw
  abandoned_.set_params(abandoned_params(params));
  sonar_.set_params(params.sonar);
  // The integral goes on asking for the same force.
  for (int i = 0; i < 3; ++i) {
    const double gain = params.controller.integral_gain(i);
    if (gain > 0.0) integral_.value(i) *= params_.controller.integral_gain(i) / gain;
  }
  controller_ = controller;
  params_ = params;
}

void FlightLoop::set_estimate(Time time, const RigidBodyState& state) {
  const bool usable = state.p_WB.allFinite() && state.v_WB_W.allFinite() &&
                      std::abs(state.q_WB.norm() - 1.0) < 1e-3;
  if (usable) new_estimate_ = {time, state};
}

void FlightLoop::set_setpoint(const FlightSetpoint& setpoint) {
  if (setpoint.kind == SetpointKind::kTrack && !finite(setpoint.reference)) return;
  if (setpoint.kind == SetpointKind::kMotorsOff) {
    // After a gap it comes from a commander who knows nothing of this flight.
    const bool obeyed = law_ == Law::kOff || commanded_;
    motors_off_refused_ = !obeyed;
    if (!obeyed) return;
    landed_alone_ = false;
  }
  setpoint_ = setpoint;
  setpoint_freshness_ = {setpoint.time, std::nullopt};
}

/// Takes in what came since the last step.
void FlightLoop::hear(Time now, double dt, const ImuSample& imu) {
  if (new_estimate_ && Freshness::plausible(new_estimate_->first, now, params_.estimate_timeout)) {
    carry_.correct(new_estimate_->first, new_estimate_->second);
    estimate_freshness_ = {new_estimate_->first, now};
  }
  new_estimate_.reset();
  carry_.advance(now, imu);
  if (!estimate_is_fresh(now)) carry_.let_go();
  sonar_.step(now);
  flown_ = extrapolate(flown_, dt);

  if (!setpoint_freshness_.heard) setpoint_freshness_.heard = now;
  commanded_ = setpoint_freshness_.age(now) <= params_.setpoint_timeout;
  if (commanded_) uncommanded_since_.reset();
  if (!commanded_ && !uncommanded_since_) uncommanded_since_ = now;
}

FlightLoop::Output FlightLoop::step(Time now, const ImuSample& imu) {
  const double dt = last_step_ ? std::clamp(to_seconds(now - *last_step_), 0.0, kMaxStep) : 0.0;
  last_step_ = now;
  hear(now, dt, imu);
  Output output = fly(now, dt);
  output.setpoint_age = setpoint_freshness_.age(now);
  output.estimate_age = estimate_freshness_.age(now);
  output.motors_off_refused = motors_off_refused_;
  motors_off_refused_ = false;
  return output;
}

FlightLoop::Output FlightLoop::fly(Time now, double dt) {
  if (landed_alone_) return off(Behaviour::kLanded);
  if (setpoint_.kind == SetpointKind::kMotorsOff) return off(Behaviour::kMotorsOff);
  if (law_ == Law::kOff && !commanded_) return off(Behaviour::kMotorsOff);

  const Knowledge known = knowledge(now);
  if (known == Knowledge::kPosition && commanded_ && setpoint_.kind == SetpointKind::kTrack) {
    return track(now, dt);
  }
  if (known == Knowledge::kPosition && !commanded_) return abandoned(now, dt);

  const bool on_ground = sonar_.near_ground_for().value_or(0.0) >= params_.ground_time;
  if (!commanded_ && on_ground) {
    landed_alone_ = true;
    return off(Behaviour::kLanded);
  }
  if (known == Knowledge::kPosition) return sink(now, Behaviour::kLevel);
  if (known == Knowledge::kVelocity) return sink(now, Behaviour::kStaleEstimate);
  return level(Behaviour::kBlind);
}

bool FlightLoop::estimate_is_fresh(Time now) const {
  return estimate_freshness_.age(now) <= params_.estimate_timeout;
}

FlightLoop::Knowledge FlightLoop::knowledge(Time now) const {
  if (estimate_is_fresh(now)) return Knowledge::kPosition;
  const double age = estimate_freshness_.age(now);
  if (!carry_.motion_known()) return Knowledge::kAttitude;
  if (age <= params_.inertial_timeout) return Knowledge::kPosition;
  return age <= params_.velocity_timeout ? Knowledge::kVelocity : Knowledge::kAttitude;
}

/// Where a new reference begins: on the one that is flown, or, where the vehicle was carried off
/// it, at the vehicle.
FlatReference FlightLoop::continued() const {
  const RigidBodyState& state = carry_.state();
  if (law_ == Law::kOff || law_ == Law::kLevel) return at_vehicle(state);
  FlatReference flown = flown_;
  if (law_ == Law::kSink) flown.position = state.p_WB;
  const bool on_it = (flown.position - state.p_WB).norm() <= kMaxDistance &&
                     (flown.velocity - state.v_WB_W).norm() <= kMaxDifference;
  return on_it ? flown : at_vehicle(state);
}

FlightLoop::Output FlightLoop::off(Behaviour behaviour) {
  law_ = Law::kOff;
  integral_ = {};
  Output output;
  output.behaviour = behaviour;
  return output;
}

FlightLoop::Output FlightLoop::track(Time now, double dt) {
  const FlatReference wanted = extrapolate(setpoint_.reference, to_seconds(now - setpoint_.time));
  if (law_ == Law::kOff) merge_ = {};
  if (law_ != Law::kOff && law_ != Law::kTrack) {
    merge_.begin(now, continued(), wanted, params_.abandoned.braking, params_.merging);
  }
  law_ = Law::kTrack;
  const bool fresh = estimate_freshness_.age(now) <= params_.estimate_timeout;
  Output output =
      follow(fresh ? Behaviour::kTracking : Behaviour::kInertial, merge_.apply(now, wanted));
  integral_ = controller_.integrate(integral_, output.tracking, dt);
  return output;
}

FlightLoop::Output FlightLoop::abandoned(Time now, double dt) {
  if (law_ != Law::kAbandoned) {
    Status begun = abandoned_.begin(*uncommanded_since_, now, continued());
    if (!begun.ok()) return level(Behaviour::kBlind);  // kilometres away
  }
  law_ = Law::kAbandoned;
  const FlatReference reference = abandoned_.reference(now);
  if (abandoned_.landed(now, carry_.state().p_WB.z(), sonar_)) {
    landed_alone_ = true;
    return off(Behaviour::kLanded);
  }
  Output output =
      follow(abandoned_.landing() ? Behaviour::kAbandoned : Behaviour::kStaleSetpoint, reference);
  integral_ = controller_.integrate(integral_, output.tracking, dt);
  return output;
}

/// The integral stays as it was, which holds against a steady wind. A position counts only as far
/// as the IMU carries it on: one that is estimated and not trusted may jump.
FlightLoop::Output FlightLoop::sink(Time now, Behaviour behaviour) {
  if (law_ != Law::kSink) {
    const auto descent =
        SteadyDescent::begin(now, continued(), params_.landing_speed, params_.abandoned.braking);
    if (!descent.ok()) return level(Behaviour::kBlind);  // kilometres away
    descent_ = *descent;
    descent_offset_.setZero();
  }
  law_ = Law::kSink;
  FlatReference reference = descent_.at(now);
  if (estimate_is_fresh(now)) descent_offset_ = carry_.state().p_WB - reference.position;
  reference.position += descent_offset_;
  return follow(behaviour, reference);
}

FlightLoop::Output FlightLoop::level(Behaviour behaviour) {
  law_ = Law::kLevel;
  Output output;
  output.behaviour = behaviour;
  output.mixer = mixer_.mix(controller_.level(carry_.state(), params_.sinking_thrust_to_weight));
  output.rotor_thrusts = output.mixer.rotor_thrusts;
  return output;
}

FlightLoop::Output FlightLoop::follow(Behaviour behaviour, const FlatReference& reference) {
  flown_ = reference;
  Output output;
  output.behaviour = behaviour;
  output.reference = reference;
  output.tracking = controller_.compute(carry_.state(), reference, integral_);
  output.mixer = mixer_.mix(output.tracking.wrench);
  output.rotor_thrusts = output.mixer.rotor_thrusts;
  return output;
}

std::string describe(const FlightLoop::Output& output) {
  const auto none = [](const char* what, double age) {
    return std::isfinite(age) ? fmt::format("no {} for {:.2f} s", what, age)
                              : fmt::format("no usable {}", what);
  };
  const auto abandoned = [&](const char* what) {
    return std::isfinite(output.setpoint_age)
               ? fmt::format("{} for {:.2f} s", what, output.setpoint_age)
               : std::string("setpoints are of another clock");
  };
  switch (output.behaviour) {
    case FlightLoop::Behaviour::kMotorsOff:
      return "motors off";
    case FlightLoop::Behaviour::kTracking:
      return "tracking the setpoint";
    case FlightLoop::Behaviour::kInertial:
      return none("odometry", output.estimate_age) + ": carrying the state on with the IMU";
    case FlightLoop::Behaviour::kLevel:
      return "braking and sinking without a position, as asked";
    case FlightLoop::Behaviour::kStaleSetpoint:
      return abandoned("nobody sends setpoints") + ": braking";
    case FlightLoop::Behaviour::kAbandoned:
      return abandoned("abandoned") + ": landing";
    case FlightLoop::Behaviour::kLanded:
      return "landed by itself: motors off";
    case FlightLoop::Behaviour::kStaleEstimate:
      return none("odometry", output.estimate_age) + ": braking and sinking by the IMU";
    case FlightLoop::Behaviour::kBlind:
      return none("odometry", output.estimate_age) + ": level and sinking, by the gyroscope alone";
  }
  return "unknown";
}

}  // namespace swiftlet
