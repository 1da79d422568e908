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

constexpr Answer kGo = Answer::kGo;
constexpr Answer kAlready = Answer::kAlready;
constexpr Answer kRefuse = Answer::kRefuse;
constexpr Mode kGrounded = Mode::kGrounded;
constexpr Mode kTakeoff = Mode::kTakeoff;
constexpr Mode kHover = Mode::kHover;
constexpr Mode kLand = Mode::kLand;
constexpr Mode kNavigation = Mode::kIndoorNavigation;
constexpr Mode kExploration = Mode::kIndoorExploration;

// A take-off to an altitude this close to the last one is the same take-off [m].
constexpr double kSameAltitude = 1e-3;

// Grounded is listed twice: disarmed and armed. All other modes are armed.
constexpr std::array kRules{
    RequestRule{kGrounded, false, Kind::kArm, kGo, kGrounded, ""},
    RequestRule{kGrounded, false, Kind::kDisarm, kAlready, kGrounded, "disarmed"},
    RequestRule{kGrounded, false, Kind::kTakeoff, kRefuse, kGrounded, "not armed; send arm first"},
    RequestRule{kGrounded, false, Kind::kHover, kRefuse, kGrounded,
                "on the ground; send arm, then takeoff"},
    RequestRule{kGrounded, false, Kind::kLand, kAlready, kGrounded, "on the ground"},
    RequestRule{kGrounded, false, Kind::kNavigate, kRefuse, kGrounded,
                "on the ground; send arm, then takeoff"},
    RequestRule{kGrounded, false, Kind::kExplore, kRefuse, kGrounded,
                "on the ground; send arm, then takeoff"},

    RequestRule{kGrounded, true, Kind::kArm, kAlready, kGrounded, "armed"},
    RequestRule{kGrounded, true, Kind::kDisarm, kGo, kGrounded, ""},
    RequestRule{kGrounded, true, Kind::kTakeoff, kGo, kTakeoff, ""},
    RequestRule{kGrounded, true, Kind::kHover, kRefuse, kGrounded,
                "on the ground; send takeoff first"},
    RequestRule{kGrounded, true, Kind::kLand, kAlready, kGrounded, "on the ground"},
    RequestRule{kGrounded, true, Kind::kNavigate, kRefuse, kGrounded,
                "on the ground; send takeoff first"},
    RequestRule{kGrounded, true, Kind::kExplore, kRefuse, kGrounded,
                "on the ground; send takeoff first"},

    RequestRule{kTakeoff, true, Kind::kArm, kAlready, kTakeoff, "armed"},
    RequestRule{kTakeoff, true, Kind::kDisarm, kRefuse, kTakeoff, "in the air; send land first"},
    RequestRule{kTakeoff, true, Kind::kTakeoff, kAlready, kTakeoff, "taking off"},
    RequestRule{kTakeoff, true, Kind::kHover, kGo, kHover, ""},
    RequestRule{kTakeoff, true, Kind::kLand, kGo, kLand, ""},
    RequestRule{kTakeoff, true, Kind::kNavigate, kRefuse, kTakeoff,
                "take-off is not finished; wait for Hover"},
    RequestRule{kTakeoff, true, Kind::kExplore, kRefuse, kTakeoff,
                "take-off is not finished; wait for Hover"},

    RequestRule{kHover, true, Kind::kArm, kAlready, kHover, "armed"},
    RequestRule{kHover, true, Kind::kDisarm, kRefuse, kHover, "in the air; send land first"},
    RequestRule{kHover, true, Kind::kTakeoff, kAlready, kHover, "in the air"},
    RequestRule{kHover, true, Kind::kHover, kAlready, kHover, "hovering"},
    RequestRule{kHover, true, Kind::kLand, kGo, kLand, ""},
    RequestRule{kHover, true, Kind::kNavigate, kGo, kNavigation, ""},
    RequestRule{kHover, true, Kind::kExplore, kGo, kExploration, ""},

    RequestRule{kLand, true, Kind::kArm, kAlready, kLand, "armed"},
    RequestRule{kLand, true, Kind::kDisarm, kRefuse, kLand, "landing; it disarms by itself"},
    RequestRule{kLand, true, Kind::kTakeoff, kRefuse, kLand,
                "landing; send hover to stay in the air"},
    RequestRule{kLand, true, Kind::kHover, kGo, kHover, ""},
    RequestRule{kLand, true, Kind::kLand, kAlready, kLand, "landing"},
    RequestRule{kLand, true, Kind::kNavigate, kRefuse, kLand,
                "landing; send hover to stay in the air"},
    RequestRule{kLand, true, Kind::kExplore, kRefuse, kLand,
                "landing; send hover to stay in the air"},

    RequestRule{kNavigation, true, Kind::kArm, kAlready, kNavigation, "armed"},
    RequestRule{kNavigation, true, Kind::kDisarm, kRefuse, kNavigation,
                "in the air; send land first"},
    RequestRule{kNavigation, true, Kind::kTakeoff, kAlready, kNavigation, "in the air"},
    RequestRule{kNavigation, true, Kind::kHover, kGo, kHover, ""},
    RequestRule{kNavigation, true, Kind::kLand, kGo, kLand, ""},
    // The same mission again changes nothing; another one replaces it.
    RequestRule{kNavigation, true, Kind::kNavigate, kGo, kNavigation, ""},
    RequestRule{kNavigation, true, Kind::kExplore, kGo, kExploration, ""},

    RequestRule{kExploration, true, Kind::kArm, kAlready, kExploration, "armed"},
    RequestRule{kExploration, true, Kind::kDisarm, kRefuse, kExploration,
                "in the air; send land first"},
    RequestRule{kExploration, true, Kind::kTakeoff, kAlready, kExploration, "in the air"},
    RequestRule{kExploration, true, Kind::kHover, kGo, kHover, ""},
    RequestRule{kExploration, true, Kind::kLand, kGo, kLand, ""},
    RequestRule{kExploration, true, Kind::kNavigate, kGo, kNavigation, ""},
    RequestRule{kExploration, true, Kind::kExplore, kAlready, kExploration, "exploring"},
};

constexpr std::array<EventRule, 11> kEvents{{
    {Event::kLanded, kLand, kGrounded},
    {Event::kEstimateLost, kTakeoff, kLand},
    {Event::kEstimateLost, kHover, kLand},
    {Event::kEstimateLost, kNavigation, kLand},
    {Event::kEstimateLost, kExploration, kLand},
    {Event::kTakeoffFailed, kTakeoff, kLand},
    {Event::kReferenceFinished, kTakeoff, kHover},
    {Event::kNavigationFailed, kNavigation, kHover},
    {Event::kNavigationFailed, kExploration, kHover},
    {Event::kNavigationFinished, kNavigation, kHover},
    {Event::kNavigationFinished, kExploration, kHover},
}};

std::string because(const char* what, const std::string& detail) {
  return detail.empty() ? std::string(what) : fmt::format("{}: {}", what, detail);
}

}  // namespace

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::kGrounded:
      return "Grounded";
    case Mode::kTakeoff:
      return "Takeoff";
    case Mode::kHover:
      return "Hover";
    case Mode::kLand:
      return "Land";
    case Mode::kIndoorNavigation:
      return "Indoor Navigation";
    case Mode::kIndoorExploration:
      return "Indoor Exploration";
  }
  return "unknown";
}

const char* to_string(Kind kind) {
  switch (kind) {
    case Kind::kArm:
      return "arm";
    case Kind::kDisarm:
      return "disarm";
    case Kind::kTakeoff:
      return "takeoff";
    case Kind::kHover:
      return "hover";
    case Kind::kLand:
      return "land";
    case Kind::kNavigate:
      return "navigate";
    case Kind::kExplore:
      return "explore";
  }
  return "unknown";
}

const char* to_string(Event event) {
  switch (event) {
    case Event::kEstimateLost:
      return "estimate lost";
    case Event::kLanded:
      return "landed";
    case Event::kTakeoffFailed:
      return "still on the ground at the end of the climb";
    case Event::kReferenceFinished:
      return "altitude reached";
    case Event::kNavigationFailed:
      return "navigation failed";
    case Event::kNavigationFinished:
      return "mission finished";
  }
  return "unknown";
}

std::string describe(const Transition& transition) {
  return fmt::format("{} -> {}: {}", to_string(transition.from), to_string(transition.to),
                     transition.reason);
}

const RequestRule& ModeMachine::rule(Mode mode, bool armed, Kind request) {
  for (const RequestRule& rule : kRules) {
    const bool same_row = rule.mode == mode && (rule.armed == armed || mode != kGrounded);
    if (same_row && rule.request == request) return rule;
  }
  // A value that is no enumerator: answered as on the ground, where nothing can go wrong.
  static constexpr RequestRule kUnknown{kGrounded, false,     Kind::kArm,
                                        kRefuse,   kGrounded, "unknown mode or request"};
  return kUnknown;
}

const std::array<EventRule, 11>& ModeMachine::event_rules() {
  return kEvents;
}

ModeMachine::ModeMachine(const Params& params) : params_(params) {
  const bool fine = std::isfinite(params.max_altitude) && params.min_altitude > 0.0 &&
                    params.max_altitude >= params.min_altitude &&
                    params.landed_confirmation >= 0.0 && params.landed_confirmation <= 60.0;
  if (!fine) {
    throw std::invalid_argument(
        "modes: altitudes must be positive with min_altitude <= max_altitude, landed_confirmation "
        "from 0 to 60 s");
  }
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
  const bool is_guided = request.kind == Kind::kNavigate || request.kind == Kind::kExplore;
  if (is_guided && !request.mission_problem.empty()) {
    return object(request.mission_problem);
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
  const RequestRule& rule = ModeMachine::rule(mode_, armed_, request.kind);
  if (rule.answer == kRefuse) return refuse(rule.reason);
  if (rule.answer == kAlready) {
    // Another altitude is another request, and the climb is not for changing.
    const bool same = std::abs(request.altitude - takeoff_altitude_) <= kSameAltitude;
    if (request.kind == Kind::kTakeoff && !same) {
      return refuse(fmt::format("{} already, to {:.2f} m", rule.reason, takeoff_altitude_));
    }
    return Acceptance::kUnchanged;
  }
  if (mode_ == kNavigation && request.kind == Kind::kNavigate && request.mission == mission_) {
    return Acceptance::kUnchanged;
  }
  if (const auto error = objection(request, situation)) return refuse(error->reason);

  if (request.kind == Kind::kArm) armed_ = true;
  if (request.kind == Kind::kDisarm) armed_ = false;
  if (request.kind == Kind::kTakeoff) takeoff_altitude_ = request.altitude;
  if (request.kind == Kind::kNavigate) mission_ = request.mission;
  mode_ = rule.to;
  blind_ = mode_ == kLand && !situation.estimate_ok;
  return Acceptance::kChanged;
}

void ModeMachine::watch_ground(const Situation& situation) {
  if (!situation.on_ground) {
    on_ground_since_.reset();
  } else if (!on_ground_since_ || *on_ground_since_ > situation.now) {
    on_ground_since_ = situation.now;
  }
}

bool ModeMachine::holds(Event event, const Situation& situation) const {
  switch (event) {
    case Event::kEstimateLost:
      return !situation.estimate_ok;
    case Event::kLanded:
      return on_ground_since_ && to_seconds(situation.now) - to_seconds(*on_ground_since_) >=
                                     params_.landed_confirmation;
    case Event::kTakeoffFailed:
      return situation.reference_finished && situation.on_ground;
    case Event::kReferenceFinished:
      return situation.reference_finished && !situation.on_ground;
    case Event::kNavigationFailed:
      return situation.navigation == Navigation::kFailed;
    case Event::kNavigationFinished:
      return situation.navigation == Navigation::kFinished;
  }
  return false;
}

std::string ModeMachine::reason(Event event, const Situation& situation) const {
  switch (event) {
    case Event::kEstimateLost:
      return because("estimate lost", situation.estimate_problem);
    case Event::kReferenceFinished:
      return fmt::format("{:.2f} m reached", situation.height);
    case Event::kTakeoffFailed:
      return because(to_string(event), situation.motors_problem);
    case Event::kNavigationFailed:
      return situation.navigation_problem.empty() ? to_string(event) : situation.navigation_problem;
    default:
      return to_string(event);
  }
}

std::optional<Transition> ModeMachine::update(const Situation& situation) {
  watch_ground(situation);
  for (const EventRule& rule : kEvents) {
    if (rule.from != mode_ || !holds(rule.event, situation)) continue;
    mode_ = rule.to;
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
  on_ground_since_.reset();
}

}  // namespace swiftlet
