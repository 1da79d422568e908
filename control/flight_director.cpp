// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_director.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// A flight controller that was not heard for so long is not there [s].
constexpr double kMotorsTimeout = 0.5;

double age(Time now, const std::optional<Time>& then) {
  return then ? to_seconds(now - *then) : 1e9;
}

bool positive(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return v > 0.0 && std::isfinite(v); });
}

/// Whether references can be made with these limits.
bool usable(const ReferenceLimits& limits) {
  return FlightReference::move({}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.0, limits).ok();
}

/// Throws std::invalid_argument where a parameter cannot be used.
void check(const FlightDirector::Params& params) {
  const bool fine = usable(params.takeoff) && usable(params.landing) && usable(params.braking) &&
                    positive({params.landing_depth, params.landing_resistance, params.ground_range,
                              params.ground_height, params.plan_gap, params.arrival_distance,
                              params.arrival_speed, params.arrival_timeout, params.plan_timeout,
                              params.exploration_timeout, params.estimate_timeout,
                              params.estimate_sigma_max, params.heading_sigma_to_arm}) &&
                    params.settling_to_arm >= 0.0 && params.settling_to_arm <= 3600.0 &&
                    params.landing_resistance <= params.landing_depth &&
                    params.min_battery_percentage >= 0.0 && params.min_battery_percentage <= 1.0;
  if (!fine) {
    throw std::invalid_argument(
        "flight director: speeds and accelerations must be from 0.001 to 10000, distances, "
        "timeouts and sigmas positive, landing_resistance at most landing_depth, "
        "min_battery_percentage from 0 to 1");
  }
  const bool steerable =
      params.steering.usable() && usable(params.cruise) &&
      positive({params.takeover, params.sticks_period, params.sticks_timeout, params.vehicle_radius,
                params.obstacle_distance, params.obstacles_timeout, params.lowest_range,
                params.gps_altitude, params.link_timeout}) &&
      params.takeover > params.steering.dead_band && params.takeover <= 1.0;
  const bool guarded = params.fence.radius >= 0.0 && std::isfinite(params.fence.radius) &&
                       params.fence.height >= 0.0 && std::isfinite(params.fence.height) &&
                       params.critical_battery >= 0.0 && params.low_battery <= 1.0 &&
                       params.critical_battery <= params.low_battery;
  if (!steerable || !guarded) {
    throw std::invalid_argument(
        "flight director: limits of steering, distances and timeouts must be positive, the dead "
        "band from 0 to 0.5 and below takeover, which is at most 1, the fence not negative, "
        "batteries from 0 to 1 with critical_battery <= low_battery");
  }
}

}  // namespace

FlightDirector::FlightDirector(const Params& params) : params_(params), machine_(params.modes) {
  check(params);
}

void FlightDirector::set_params(const Params& params) {
  check(params);
  machine_.set_params(params.modes);
  params_ = params;
}

void FlightDirector::set_estimate(Time time, const RigidBodyState& state, double position_sigma,
                                  double heading_sigma) {
  const bool usable = state.p_WB.allFinite() && state.v_WB_W.allFinite() &&
                      std::abs(state.q_WB.norm() - 1.0) < 1e-3;
  if (!usable) return;  // its age will tell
  const bool goes_on = std::abs(age(time, estimate_time_)) <= params_.estimate_timeout;
  if (!goes_on) estimate_since_ = time;
  state_ = state;
  estimate_time_ = time;
  position_sigma_ = position_sigma;
  heading_sigma_ = heading_sigma;
}

void FlightDirector::set_range_down(double range) {
  if (!std::isnan(range)) range_down_ = range;
}

void FlightDirector::set_battery(double percentage) {
  battery_percentage_.reset();
  if (!std::isnan(percentage)) battery_percentage_ = percentage;
}

std::string FlightDirector::estimate_problem(Time now) const {
  if (!estimate_time_) return "no odometry was heard; is the estimator running?";
  if (age(now, estimate_time_) > params_.estimate_timeout) {
    return fmt::format("no odometry for {:.2f} s", age(now, estimate_time_));
  }
  if (age(now, estimate_time_) < -params_.estimate_timeout) {
    return fmt::format("odometry is stamped {:.2f} s ahead; do the clocks agree?",
                       -age(now, estimate_time_));
  }
  if (!(position_sigma_ <= params_.estimate_sigma_max)) {
    return fmt::format("position is known to {:.2f} m only", position_sigma_);
  }
  return "";
}

std::string FlightDirector::not_ready_reason(Time now) const {
  const std::string estimate = estimate_problem(now);
  if (!estimate.empty()) return estimate;
  if (!(heading_sigma_ <= params_.heading_sigma_to_arm)) {
    return fmt::format("heading is known to {:.3f} rad only, {:.3f} are needed; wait",
                       std::ceil(1e3 * heading_sigma_) / 1e3, params_.heading_sigma_to_arm);
  }
  if (const double left = params_.settling_to_arm - age(now, estimate_since_); left > 0.0) {
    return fmt::format("the estimate settles for {:.1f} s more", std::max(left, 0.1));
  }
  if (age(now, motors_heard_) > kMotorsTimeout) {
    return "no motor commands were heard; is the flight_controller running?";
  }
  if (!range_down_) return "nothing was heard on range/down; is the sonar running?";
  if (machine_.mode() == Mode::kGrounded && !sonar_near_ground()) {
    if (!std::isfinite(*range_down_)) {
      return "the sonar hears no echo of the ground: set it down, or look at what it points to";
    }
    return fmt::format("the ground is {:.2f} m below: set it down, or wait until it has landed",
                       *range_down_);
  }
  if (battery_percentage_ && *battery_percentage_ < params_.min_battery_percentage) {
    return fmt::format("battery at {:.0f} %, {:.0f} % are needed to take off",
                       *battery_percentage_ * 100.0, params_.min_battery_percentage * 100.0);
  }
  return system_problem_;
}

Situation FlightDirector::situation(Time now) const {
  Situation situation;
  situation.now = now;
  situation.not_ready_reason = not_ready_reason(now);
  situation.ready = situation.not_ready_reason.empty();
  situation.estimate_problem = estimate_problem(now);
  situation.estimate_ok = situation.estimate_problem.empty();
  situation.height = state_.p_WB.z() - flying_.takeoff_point.z();
  if (machine_.armed()) {
    // Furniture below must not look like the ground: the height has to agree while it is known.
    situation.on_ground = sonar_near_ground() && (low() || !situation.estimate_ok);
  } else {
    situation.on_ground = sonar_near_ground() || !range_down_;  // without it, not ready is said
  }
  situation.reference_finished = now >= flying_.simple.end();
  if (age(now, motors_heard_) > kMotorsTimeout) {
    situation.motors_problem =
        guidance_problem_.empty() ? "no motor commands were heard" : guidance_problem_;
  }
  situation.sticks_problem = sticks_problem(now);
  situation.obstacles_problem = obstacles_problem(now);
  situation.navigation = flying_.navigation;
  situation.navigation_problem = flying_.navigation_problem;
  return situation;
}

bool FlightDirector::sonar_near_ground() const {
  return range_down_ && *range_down_ < params_.ground_range;
}

bool FlightDirector::low() const {
  return state_.p_WB.z() - flying_.takeoff_point.z() < params_.ground_height;
}

/// Of three witnesses (resistance, sonar, height) all are heard, or, where sonar and height do not
/// agree (a table, a higher floor, a sonar without echo), one of them and much more resistance.
bool FlightDirector::landed(Time now) const {
  if (flying_.blind || !estimate_problem(now).empty()) return sonar_near_ground();
  const double resistance = state_.p_WB.z() - reference(now).position.z();
  if (sonar_near_ground() && low()) return resistance >= params_.landing_resistance;
  return (sonar_near_ground() || low()) && resistance >= params_.landing_depth;
}

Result<Acceptance> FlightDirector::request(const Request& request, Time now) {
  if (request.kind == Request::Kind::kExplore) return explore(now);
  if (request.kind == Request::Kind::kReturn) return go_back(now);
  const Mode before = machine_.mode();
  Result<Acceptance> result = machine_.request(request, situation(now));
  if (!result.ok() || *result != Acceptance::kChanged) return result;
  if (request.kind == Request::Kind::kArm) flying_.takeoff_point = state_.p_WB;
  flying_.last_reason = fmt::format("{} requested", to_string(request.kind));
  if (machine_.mode() != before) enter(machine_.mode(), now);
  return result;
}

FlightDirector::Directive FlightDirector::tick(Time now) {
  heed_sticks(now);
  if (is_steered()) follow_sticks(now);
  if (machine_.mode() == Mode::kGpsGuidance) follow_legs(now);
  if (machine_.mode() == Mode::kIndoorNavigation) follow_mission(now);
  if (machine_.mode() == Mode::kIndoorExploration) follow_exploration(now);

  Situation seen = situation(now);
  heed_policies(now, seen);
  heed_guard(now, seen);
  if (machine_.mode() == Mode::kLand) seen.on_ground = landed(now);
  Directive directive;
  directive.transition = machine_.update(seen);
  if (directive.transition) {
    flying_.last_reason = directive.transition->reason;
    enter(directive.transition->to, now);
  }
  if (machine_.mode() == Mode::kLand) sink(now);

  directive.setpoint.time = now;
  if (machine_.mode() == Mode::kGrounded) {
    directive.setpoint.kind = SetpointKind::kMotorsOff;
  } else if (machine_.level_descent()) {
    directive.setpoint.kind = SetpointKind::kLevel;
  } else {
    directive.setpoint.kind = SetpointKind::kTrack;
  }
  directive.setpoint.reference = reference(now);
  if (is_guided()) directive.goal = flying_.goal;
  return directive;
}

FlatReference FlightDirector::reference(Time now) const {
  return flying_.active ? flying_.active->evaluate(now) : flying_.simple.evaluate(now);
}

FlatReference FlightDirector::at_vehicle() const {
  FlatReference reference;
  reference.position = state_.p_WB;
  reference.velocity = state_.v_WB_W;
  reference.yaw = yaw_of(state_.q_WB);
  return reference;
}

void FlightDirector::enter(Mode mode, Time now) {
  // After a blind descent nothing is known of where the old reference is, and the guard does not
  // follow it.
  const bool unknown = std::exchange(flying_.blind, false) || guard_acting_;
  const FlatReference flown = unknown ? at_vehicle() : reference(now);
  flying_.navigation = Navigation::kInactive;
  flying_.goal.reset();
  answers_.clear();
  still_at_.reset();
  switch (mode) {
    case Mode::kTakeoff: {
      flying_.takeoff_point = state_.p_WB;
      Eigen::Vector3d above = flying_.takeoff_point;
      above.z() += machine_.takeoff_altitude();
      stop(at_vehicle(), now);
      const auto climb = FlightReference::move(now, flying_.takeoff_point, above,
                                               yaw_of(state_.q_WB), params_.takeoff);
      if (climb.ok()) flying_.simple = climb->trajectory();
      break;
    }
    case Mode::kGrounded: {
      FlatReference rest = at_vehicle();
      rest.velocity.setZero();
      stop(rest, now);
      break;
    }
    case Mode::kLand:
      // A climb that has not left the ground is not sunk from its end.
      stop(sonar_near_ground() && low() ? at_vehicle() : flown, now);
      break;
    case Mode::kHover:
    case Mode::kManual:
    case Mode::kAssistedManual:
      stop(flown, now);
      break;
    case Mode::kGpsGuidance:
    case Mode::kIndoorNavigation:
    case Mode::kIndoorExploration:
      stop(flown, now);
      flying_.navigation = Navigation::kActive;
      if (machine_.returning()) {
        const Eigen::Vector3d& home = flying_.takeoff_point;
        flying_.waypoints = {{{home.x(), home.y(), flown.position.z()}, std::nullopt}};
        flying_.waypoint = 0;
      }
      break;
  }
}

/// Forgets all plans and brakes to rest.
void FlightDirector::stop(const FlatReference& from, Time now) {
  flying_.active.reset();
  flying_.coming.clear();
  auto brake = FlightReference::brake(now, from, params_.braking);
  if (!brake.ok()) brake = FlightReference::hold(state_.p_WB, yaw_of(state_.q_WB));
  if (brake.ok()) flying_.simple = brake->trajectory();
}

/// Once at rest downwards, and further where the ground does not come.
void FlightDirector::sink(Time now) {
  const bool was_blind = std::exchange(flying_.blind, machine_.level_descent());
  if (flying_.blind) return;
  if (was_blind) stop(at_vehicle(), now);
  if (now < flying_.simple.end()) return;
  const FlatReference rest = flying_.simple.final_reference();
  Eigen::Vector3d below = rest.position;
  below.z() = std::min(below.z(), flying_.takeoff_point.z()) - params_.landing_depth;
  const auto descent = FlightReference::move(now, rest.position, below, rest.yaw, params_.landing);
  if (descent.ok()) flying_.simple = descent->trajectory();
}

FlightDirector::Status FlightDirector::status(Time now) const {
  Status status;
  status.mode = machine_.mode();
  status.armed = machine_.armed();
  const std::string not_ready = not_ready_reason(now);
  status.ready = not_ready.empty();
  const bool waiting = machine_.mode() == Mode::kGrounded && !machine_.armed();
  status.reason = waiting && !status.ready ? not_ready : flying_.last_reason;
  status.height = state_.p_WB.z() - flying_.takeoff_point.z();
  status.waypoint = flying_.waypoints.empty() ? 0 : flying_.waypoint + 1;
  status.waypoint_count = flying_.waypoints.size();
  status.number = flying_.waypoints.empty() ? 0 : flying_.first_number + flying_.waypoint;
  status.mission_done = flying_.mission_done;
  status.home = flying_.takeoff_point;
  return status;
}

FlightDirector::State FlightDirector::state() const {
  State state = flying_;
  state.machine = machine_.state();
  return state;
}

void FlightDirector::restore(const State& state) {
  flying_ = state;
  machine_.restore(state.machine);
  // The explorer says it again; what it said before may be of an earlier exploration.
  order_.reset();
  order_heard_.reset();
  idle_since_.reset();
  still_at_.reset();
}

}  // namespace swiftlet
