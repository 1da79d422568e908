// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mode_machine.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace swiftlet {
namespace {

using Kind = Request::Kind;
using Answer = RequestRule::Answer;
using Event = EventRule::Event;
using Navigation = Situation::Navigation;

constexpr Answer kAlready = Answer::kAlready;
constexpr Answer kRefuse = Answer::kRefuse;
constexpr Mode kGrounded = Mode::kGrounded;
constexpr Mode kTakeoff = Mode::kTakeoff;
constexpr Mode kLand = Mode::kLand;
constexpr Mode kGps = Mode::kGpsGuidance;
constexpr Mode kNavigation = Mode::kIndoorNavigation;

// A take-off to an altitude this close to the last one is the same take-off [m].
constexpr double kSameAltitude = 1e-3;
// Who hovers this close to the altitude of its take-off has not flown on since [m].
constexpr double kStillThere = 0.2;

/// All but arming, which has its own words for it.
bool is_about_flight(Kind kind) {
  return kind != Kind::kArm && kind != Kind::kDisarm && kind != Kind::kTakeoff;
}

std::string because(const char* what, const std::string& detail) {
  return detail.empty() ? std::string(what) : fmt::format("{}: {}", what, detail);
}

}  // namespace

std::string describe(const Transition& transition) {
  return fmt::format("{} -> {}: {}", to_string(transition.from), to_string(transition.to),
                     transition.reason);
}

ModeMachine::ModeMachine(const Params& params) {
  set_params(params);
}

void ModeMachine::set_params(const Params& params) {
  const bool fine = std::isfinite(params.max_altitude) && params.min_altitude > 0.0 &&
                    params.max_altitude >= params.min_altitude &&
                    params.landed_confirmation >= 0.0 && params.landed_confirmation <= 60.0;
  if (!fine) {
    throw std::invalid_argument(
        "modes: altitudes must be positive with min_altitude <= max_altitude, landed_confirmation "
        "from 0 to 60 s");
  }
  params_ = params;
}

/// What stands against a request that the table would grant.
std::optional<Error> ModeMachine::objection(const Request& request,
                                            const Situation& situation) const {
  const auto object = [](std::string reason) { return Error{std::move(reason)}; };
  const bool needs_estimate = request.kind != Kind::kLand && request.kind != Kind::kDisarm;
  if (request.kind == Kind::kArm || request.kind == Kind::kTakeoff) {
    if (!situation.ready) return object(because("not ready", situation.not_ready_reason));
  }
  if (request.kind == Kind::kArm && !situation.on_ground) return object("not on the ground");
  if (request.kind == Kind::kTakeoff) {
    const double altitude = request.altitude;
    if (!(altitude >= params_.min_altitude && altitude <= params_.max_altitude)) {
      return object(fmt::format("altitude {:.2f} m is not from {:.2f} to {:.2f} m", altitude,
                                params_.min_altitude, params_.max_altitude));
    }
  }
  if (request.kind == Kind::kHover && mode_ == kLand && situation.on_ground) {
    return object("on the ground already");
  }
  if (!request.mission_problem.empty()) return object(request.mission_problem);
  const bool by_hand = request.kind == Kind::kManual || request.kind == Kind::kAssist;
  if (by_hand && !situation.sticks_problem.empty()) return object(situation.sticks_problem);
  if (request.kind == Kind::kAssist && !situation.obstacles_problem.empty()) {
    return object(situation.obstacles_problem);
  }
  if (needs_estimate && !situation.estimate_ok) {
    return object(because("no estimate", situation.estimate_problem));
  }
  return std::nullopt;
}

Result<Acceptance> ModeMachine::request(const Request& request, const Situation& situation) {
  const auto refuse = [&request](const std::string& reason) {
    return Error{fmt::format("{} refused: {}", to_string(request.kind), reason)};
  };
  const RequestRule rule = request_rule(mode_, armed_, request.kind);
  if (mode_ == kGrounded && !situation.on_ground && is_about_flight(request.kind)) {
    return refuse(
        "it is above the ground, and not by an order of this commander: in flight, the "
        "flight_controller lands it by itself");
  }
  if (rule.answer == kRefuse) return refuse(rule.reason);
  if (rule.answer == kAlready) {
    return request.kind == Kind::kTakeoff ? take_off_again(request, situation)
                                          : Result<Acceptance>(Acceptance::kUnchanged);
  }
  if (is_flown_already(request)) return Acceptance::kUnchanged;
  if (const auto error = objection(request, situation)) return refuse(error->reason);

  if (request.kind == Kind::kArm) armed_ = true;
  if (request.kind == Kind::kDisarm) armed_ = false;
  if (request.kind == Kind::kTakeoff) takeoff_altitude_ = request.altitude;
  if (request.kind == Kind::kNavigate || request.kind == Kind::kGps) mission_ = request.mission;
  returning_ = request.kind == Kind::kReturn;
  mode_ = rule.to;
  blind_ = mode_ == kLand && !situation.estimate_ok;
  return Acceptance::kChanged;
}

/// Another altitude is another request, and neither a climb nor a flight is changed by it.
Result<Acceptance> ModeMachine::take_off_again(const Request& request,
                                               const Situation& situation) const {
  const bool climbs = mode_ == kTakeoff;
  const bool same = std::abs(request.altitude - takeoff_altitude_) <= kSameAltitude;
  const bool there = climbs || std::abs(situation.height - request.altitude) <= kStillThere;
  if (same && there) return Acceptance::kUnchanged;
  if (climbs) {
    return Error{
        fmt::format("takeoff refused: taking off already, to {:.2f} m", takeoff_altitude_)};
  }
  return Error{
      fmt::format("takeoff refused: in the air already, at {:.2f} m; goto X Y Z changes "
                  "the height",
                  situation.height)};
}

/// The same mission again, or the way home again.
bool ModeMachine::is_flown_already(const Request& request) const {
  if (request.kind == Kind::kReturn) return returning_;
  const bool same = request.mission == mission_ && !returning_;
  return same && ((mode_ == kNavigation && request.kind == Kind::kNavigate) ||
                  (mode_ == kGps && request.kind == Kind::kGps));
}

void ModeMachine::watch_ground(const Situation& situation) {
  if (!situation.on_ground) {
    on_ground_since_.reset();
  } else if (!on_ground_since_ || *on_ground_since_ > situation.now) {
    on_ground_since_ = situation.now;
  }
}

bool ModeMachine::holds(Event event, const Situation& situation) const {
  using Demand = Situation::Demand;
  switch (event) {
    case Event::kLanded:
      return on_ground_since_ && to_seconds(situation.now) - to_seconds(*on_ground_since_) >=
                                     params_.landed_confirmation;
    case Event::kEstimateLost:
      return !situation.estimate_ok;
    case Event::kLandDemanded:
      return situation.demand == Demand::kLand;
    case Event::kReturnDemanded:
      return situation.demand == Demand::kReturn && !returning_;
    case Event::kHoverDemanded:
      return situation.demand == Demand::kHover;
    case Event::kTakeoffFailed:
      return situation.reference_finished && situation.on_ground;
    case Event::kReferenceFinished:
      return situation.reference_finished && !situation.on_ground;
    case Event::kReturnFailed:
      return returning_ && situation.navigation == Navigation::kFailed;
    case Event::kReturned:
      return returning_ && situation.navigation == Navigation::kFinished;
    case Event::kNavigationFailed:
      return situation.navigation == Navigation::kFailed;
    case Event::kNavigationFinished:
      return situation.navigation == Navigation::kFinished;
    case Event::kSticksSilent:
      return !situation.sticks_problem.empty();
    case Event::kObstaclesUnseen:
      return !situation.obstacles_problem.empty();
  }
  return false;
}

std::string ModeMachine::reason(Event event, const Situation& situation) const {
  const auto either = [event](const std::string& known) {
    return known.empty() ? to_string(event) : known;
  };
  switch (event) {
    case Event::kEstimateLost:
      return because("estimate lost", situation.estimate_problem);
    case Event::kReferenceFinished:
      return fmt::format("{:.2f} m reached", situation.height);
    case Event::kTakeoffFailed:
      return because(to_string(event), situation.motors_problem);
    case Event::kLandDemanded:
    case Event::kReturnDemanded:
    case Event::kHoverDemanded:
      return either(situation.demand_reason);
    case Event::kReturnFailed:
      return because(to_string(event), situation.navigation_problem);
    case Event::kNavigationFailed:
      return either(situation.navigation_problem);
    case Event::kSticksSilent:
      return either(situation.sticks_problem);
    case Event::kObstaclesUnseen:
      return either(situation.obstacles_problem);
    default:
      return to_string(event);
  }
}

std::optional<Transition> ModeMachine::update(const Situation& situation) {
  watch_ground(situation);
  for (const EventRule& rule : event_rules()) {
    if (rule.from != mode_ || !holds(rule.event, situation)) continue;
    mode_ = rule.to;
    returning_ = rule.event == Event::kReturnDemanded && mode_ != kLand;
    if (mode_ == kGrounded) armed_ = false;
    blind_ = mode_ == kLand && !situation.estimate_ok;
    return Transition{rule.from, rule.to, reason(rule.event, situation)};
  }
  blind_ = mode_ == kLand && !situation.estimate_ok;
  return std::nullopt;
}

void ModeMachine::restore(const State& state) {
  mode_ = state.mode;
  armed_ = state.armed;
  blind_ = state.blind;
  takeoff_altitude_ = state.takeoff_altitude;
  mission_ = state.mission;
  returning_ = state.returning;
  on_ground_since_.reset();
}

}  // namespace swiftlet
