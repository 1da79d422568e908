// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_director.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// A flight controller that was not heard for so long is not there [s].
constexpr double kMotorsTimeout = 0.5;
/// Farther than anything that is flown to indoors [m].
constexpr double kFarthestWaypoint = 1e4;

double age(Time now, const std::optional<Time>& then) {
  return then ? to_seconds(now - *then) : 1e9;
}

}  // namespace

FlightDirector::FlightDirector(const Params& params) : params_(params), machine_(params.modes) {}

void FlightDirector::set_estimate(Time time, const RigidBodyState& state, double position_sigma,
                                  double heading_sigma) {
  if (!state.p_WB.allFinite() || !state.v_WB_W.allFinite()) return;  // its age will tell
  state_ = state;
  estimate_time_ = time;
  position_sigma_ = position_sigma;
  heading_sigma_ = heading_sigma;
}

std::string FlightDirector::estimate_problem(Time now) const {
  if (!estimate_time_) return "no odometry was heard; is the estimator running?";
  if (age(now, estimate_time_) > params_.estimate_timeout) {
    return fmt::format("no odometry for {:.2f} s", age(now, estimate_time_));
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
                       heading_sigma_, params_.heading_sigma_to_arm);
  }
  if (age(now, motors_heard_) > kMotorsTimeout) {
    return "no motor commands were heard; is the flight_controller running?";
  }
  if (!range_down_) return "nothing was heard on range/down; is the sonar running?";
  if (battery_percentage_ && *battery_percentage_ < params_.min_battery_percentage) {
    return fmt::format("battery at {:.0f} %, {:.0f} % are needed to take off",
                       *battery_percentage_ * 100.0, params_.min_battery_percentage * 100.0);
  }
  return "";
}

Situation FlightDirector::situation(Time now) const {
  Situation situation;
  situation.now = now;
  situation.not_ready_reason = not_ready_reason(now);
  situation.ready = situation.not_ready_reason.empty();
  situation.estimate_problem = estimate_problem(now);
  situation.estimate_ok = situation.estimate_problem.empty();
  situation.height = state_.p_WB.z() - takeoff_point_.z();
  // Furniture below must not look like the ground, so the height has to agree while it is known.
  const bool near_ground = range_down_ && *range_down_ < params_.ground_range;
  const bool low = situation.height < params_.ground_height || !situation.estimate_ok;
  situation.on_ground = near_ground && (low || !machine_.armed());
  situation.reference_finished = simple_.finished(now);
  situation.navigation = navigation_;
  situation.navigation_problem = navigation_problem_;
  return situation;
}

Result<Acceptance> FlightDirector::request(const Request& request, Time now) {
  const Mode before = machine_.mode();
  Result<Acceptance> result = machine_.request(request, situation(now));
  if (!result.ok() || *result != Acceptance::kChanged) return result;
  if (request.kind == Request::Kind::kArm) takeoff_point_ = state_.p_WB;
  last_reason_ = fmt::format("{} requested", to_string(request.kind));
  if (machine_.mode() != before) enter(machine_.mode(), now);
  return result;
}

Result<Acceptance> FlightDirector::fly(std::uint64_t id,
                                       const std::vector<MissionWaypoint>& waypoints, Time now) {
  std::string problem;
  if (waypoints.empty()) problem = "it has no waypoints";
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const bool usable = waypoints[i].position.cwiseAbs().maxCoeff() < kFarthestWaypoint &&
                        waypoints[i].position.allFinite() &&
                        std::isfinite(waypoints[i].yaw.value_or(0.0));
    if (!usable) problem = fmt::format("waypoint {} is not a place that can be flown to", i + 1);
  }
  const bool replaced = machine_.mode() == Mode::kIndoorNavigation;
  Result<Acceptance> result = machine_.request(Request::navigate(id, problem), situation(now));
  if (!result.ok() || *result != Acceptance::kChanged) return result;
  last_reason_ = replaced ? "another mission requested" : "mission requested";
  waypoints_ = waypoints;
  waypoint_ = 0;
  mission_done_ = false;
  enter(Mode::kIndoorNavigation, now);
  return result;
}

void FlightDirector::set_plan(const PlanAnswer& answer) {
  if (navigation_ != Navigation::kActive || !goal_ || answer.goal != goal_->identity) return;
  if (answer.brake) {
    brake_asked_ = true;
    return;
  }
  if (answer.trajectory.empty()) {
    navigation_ = Navigation::kFailed;
    navigation_problem_ = fmt::format("{} to waypoint {}{}", answer.failure, waypoint_ + 1,
                                      answer.reason.empty() ? "" : ": " + answer.reason);
    return;
  }
  waiting_since_.reset();
  // What was to come after the beginning of this one is outdated.
  while (!coming_.empty() && coming_.back().start() >= answer.trajectory.start()) {
    coming_.pop_back();
  }
  coming_.push_back(answer.trajectory);
}

FlightDirector::Directive FlightDirector::tick(Time now) {
  while (!coming_.empty() && coming_.front().start() <= now) {
    active_ = coming_.front();
    coming_.pop_front();
  }
  if (machine_.mode() == Mode::kIndoorNavigation) follow_mission(now);

  Directive directive;
  directive.transition = machine_.update(situation(now));
  if (directive.transition) {
    last_reason_ = directive.transition->reason;
    enter(directive.transition->to, now);
  }
  if (machine_.mode() == Mode::kLand && !descending_ && simple_.finished(now)) {
    const FlatReference rest = simple_.final();
    Eigen::Vector3d below = rest.position;
    below.z() = std::min(below.z(), takeoff_point_.z()) - params_.landing_depth;
    const auto descent =
        FlightReference::move(now, rest.position, below, rest.yaw, params_.landing);
    if (descent.ok()) simple_ = *descent;
    descending_ = true;
  }

  directive.setpoint.time = now;
  if (machine_.mode() == Mode::kGrounded) {
    directive.setpoint.kind = SetpointKind::kMotorsOff;
  } else if (machine_.level_descent()) {
    directive.setpoint.kind = SetpointKind::kLevel;
  } else {
    directive.setpoint.kind = SetpointKind::kTrack;
  }
  directive.setpoint.reference = reference(now);
  if (machine_.mode() == Mode::kIndoorNavigation) directive.goal = goal_;
  return directive;
}

FlatReference FlightDirector::reference(Time now) const {
  return active_ ? active_->evaluate(now) : simple_.at(now);
}

void FlightDirector::enter(Mode mode, Time now) {
  if (mode == Mode::kIndoorNavigation) {
    rest_or_brake(now);
    navigation_ = Navigation::kActive;
    next_waypoint(now);
    return;
  }
  navigation_ = Navigation::kInactive;
  goal_.reset();
  switch (mode) {
    case Mode::kTakeoff: {
      Eigen::Vector3d above = takeoff_point_;
      above.z() += machine_.takeoff_altitude();
      const auto climb =
          FlightReference::move(now, takeoff_point_, above, yaw_of(state_.q_WB), params_.takeoff);
      if (climb.ok()) simple_ = *climb;
      active_.reset();
      break;
    }
    case Mode::kGrounded: {
      active_.reset();
      const auto here = FlightReference::hold(state_.p_WB, yaw_of(state_.q_WB));
      if (here.ok()) simple_ = *here;
      break;
    }
    default:
      rest_or_brake(now);
  }
  descending_ = false;
}

void FlightDirector::rest_or_brake(Time now) {
  const FlatReference from = reference(now);
  active_.reset();
  coming_.clear();
  const auto brake = FlightReference::brake(now, from, params_.braking);
  if (brake.ok()) simple_ = *brake;
}

void FlightDirector::next_waypoint(Time now) {
  goal_ = PlanGoal{now, waypoints_[waypoint_]};
  waiting_since_ = now;
  brake_asked_ = false;
}

void FlightDirector::follow_mission(Time now) {
  if (navigation_ != Navigation::kActive) return;
  if (std::exchange(brake_asked_, false)) {
    rest_or_brake(now);
    waiting_since_ = now;
  }
  if (waiting_since_) {
    if (to_seconds(now - *waiting_since_) > params_.plan_timeout) {
      navigation_ = Navigation::kFailed;
      navigation_problem_ =
          fmt::format("no plan to waypoint {} within {:.1f} s; is the planner running?",
                      waypoint_ + 1, params_.plan_timeout);
    }
    return;
  }
  if (!active_ || !coming_.empty() || now < active_->end()) return;
  const Eigen::Vector3d to_go = waypoints_[waypoint_].position - state_.p_WB;
  const bool arrived =
      to_go.norm() < params_.arrival_distance && state_.v_WB_W.norm() < params_.arrival_speed;
  if (arrived && waypoint_ + 1 == waypoints_.size()) {
    navigation_ = Navigation::kFinished;
    mission_done_ = true;
  } else if (arrived) {
    ++waypoint_;
    next_waypoint(now);
  } else if (to_seconds(now - active_->end()) > params_.arrival_timeout) {
    navigation_ = Navigation::kFailed;
    navigation_problem_ =
        fmt::format("waypoint {} was missed by {:.2f} m", waypoint_ + 1, to_go.norm());
  }
}

FlightDirector::Status FlightDirector::status(Time now) const {
  Status status;
  status.mode = machine_.mode();
  status.armed = machine_.armed();
  const std::string not_ready = not_ready_reason(now);
  status.ready = not_ready.empty();
  const bool waiting = machine_.mode() == Mode::kGrounded && !machine_.armed();
  status.reason = waiting && !status.ready ? not_ready : last_reason_;
  status.height = state_.p_WB.z() - takeoff_point_.z();
  status.waypoint = waypoints_.empty() ? 0 : waypoint_ + 1;
  status.waypoint_count = waypoints_.size();
  status.mission_done = mission_done_;
  return status;
}

}  // namespace swiftlet
