// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mode_table.hpp"

namespace swiftlet {
namespace {

using Kind = Request::Kind;
using Answer = RequestRule::Answer;
using Event = EventRule::Event;

constexpr Answer kGo = Answer::kGo;
constexpr Answer kAlready = Answer::kAlready;
constexpr Answer kRefuse = Answer::kRefuse;
constexpr Mode kGrounded = Mode::kGrounded;
constexpr Mode kTakeoff = Mode::kTakeoff;
constexpr Mode kHover = Mode::kHover;
constexpr Mode kLand = Mode::kLand;
constexpr Mode kManual = Mode::kManual;
constexpr Mode kAssisted = Mode::kAssistedManual;
constexpr Mode kGps = Mode::kGpsGuidance;
constexpr Mode kNavigation = Mode::kIndoorNavigation;
constexpr Mode kExploration = Mode::kIndoorExploration;

/// One answer of a mode.
struct Cell {
  Answer answer;
  Mode to;             // kGo
  const char* reason;  // else
};
constexpr Cell go(Mode to) {
  return {kGo, to, ""};
}
constexpr Cell already(const char* what) {
  return {kAlready, kGrounded, what};
}
constexpr Cell refuse(const char* why) {
  return {kRefuse, kGrounded, why};
}

constexpr Cell kArmFirst = refuse("on the ground; send arm, then takeoff");
constexpr Cell kTakeoffFirst = refuse("on the ground; send takeoff first");
constexpr Cell kClimbing = refuse("take-off is not finished; wait for Hover");
constexpr Cell kLanding = refuse("landing; send hover to stay in the air");
constexpr Cell kInTheAir = refuse("in the air; send land first");
constexpr Cell kArmed = already("armed");
constexpr Cell kAirborne = already("in the air");
constexpr Cell kOnTheGround = already("on the ground");

/// What a mode answers, in the order of kRequestKinds: arm, disarm, takeoff, hover, land; manual,
/// assist, gps; navigate, explore, return. Grounded is listed twice; all other modes are armed.
struct Row {
  Mode mode;
  bool armed;
  std::array<Cell, kRequestKinds.size()> cells;
};
// Again for a mission that is flown already is for `is_flown_already` to tell.
// clang-format off
constexpr std::array kRows{
    Row{kGrounded, false,
        {go(kGrounded), already("disarmed"), refuse("not armed; send arm first"), kArmFirst, kOnTheGround,
         kArmFirst, kArmFirst, kArmFirst,
         kArmFirst, kArmFirst, kArmFirst}},
    Row{kGrounded, true,
        {kArmed, go(kGrounded), go(kTakeoff), kTakeoffFirst, kOnTheGround,
         kTakeoffFirst, kTakeoffFirst, kTakeoffFirst,
         kTakeoffFirst, kTakeoffFirst, kTakeoffFirst}},
    Row{kTakeoff, true,
        {kArmed, kInTheAir, already("taking off"), go(kHover), go(kLand),
         go(kManual), go(kAssisted), kClimbing,
         kClimbing, kClimbing, kClimbing}},
    Row{kHover, true,
        {kArmed, kInTheAir, kAirborne, already("hovering"), go(kLand),
         go(kManual), go(kAssisted), go(kGps),
         go(kNavigation), go(kExploration), go(kNavigation)}},
    Row{kLand, true,
        {kArmed, refuse("landing; it disarms by itself"), kLanding, go(kHover), already("landing"),
         go(kManual), go(kAssisted), kLanding,
         kLanding, kLanding, kLanding}},
    Row{kManual, true,
        {kArmed, kInTheAir, kAirborne, go(kHover), go(kLand),
         already("flown by hand"), go(kAssisted), go(kGps),
         go(kNavigation), go(kExploration), go(kNavigation)}},
    Row{kAssisted, true,
        {kArmed, kInTheAir, kAirborne, go(kHover), go(kLand),
         go(kManual), already("flown by hand, assisted"), go(kGps),
         go(kNavigation), go(kExploration), go(kNavigation)}},
    Row{kGps, true,
        {kArmed, kInTheAir, kAirborne, go(kHover), go(kLand),
         go(kManual), go(kAssisted), go(kGps),
         go(kNavigation), go(kExploration), go(kGps)}},
    Row{kNavigation, true,
        {kArmed, kInTheAir, kAirborne, go(kHover), go(kLand),
         go(kManual), go(kAssisted), go(kGps),
         go(kNavigation), go(kExploration), go(kNavigation)}},
    Row{kExploration, true,
        {kArmed, kInTheAir, kAirborne, go(kHover), go(kLand),
         go(kManual), go(kAssisted), go(kGps),
         go(kNavigation), already("exploring"), go(kNavigation)}},
};
// clang-format on

constexpr std::array kFlown{kTakeoff, kHover, kManual, kAssisted, kGps, kNavigation, kExploration};

std::vector<EventRule> all_events() {
  std::vector<EventRule> rules{{Event::kLanded, kLand, kGrounded}};
  for (const Event event : {Event::kEstimateLost, Event::kLandDemanded}) {
    for (const Mode mode : kFlown) rules.push_back({event, mode, kLand});
  }
  for (const Mode mode : kFlown) {
    // Who takes off is at home.
    rules.push_back({Event::kReturnDemanded, mode,
                     mode == kTakeoff ? kLand : (mode == kGps ? kGps : kNavigation)});
  }
  for (const Mode mode : kFlown) {
    if (mode != kHover) rules.push_back({Event::kHoverDemanded, mode, kHover});
  }
  rules.push_back({Event::kTakeoffFailed, kTakeoff, kLand});
  rules.push_back({Event::kReferenceFinished, kTakeoff, kHover});
  for (const Event event : {Event::kReturnFailed, Event::kReturned}) {
    for (const Mode mode : {kGps, kNavigation}) rules.push_back({event, mode, kLand});
  }
  for (const Event event : {Event::kNavigationFailed, Event::kNavigationFinished}) {
    for (const Mode mode : {kGps, kNavigation, kExploration})
      rules.push_back({event, mode, kHover});
  }
  for (const Mode mode : {kManual, kAssisted})
    rules.push_back({Event::kSticksSilent, mode, kHover});
  rules.push_back({Event::kObstaclesUnseen, kAssisted, kHover});
  return rules;
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
    case Mode::kManual:
      return "Manual";
    case Mode::kAssistedManual:
      return "Assisted Manual";
    case Mode::kGpsGuidance:
      return "GPS Guidance";
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
    case Kind::kManual:
      return "manual";
    case Kind::kAssist:
      return "assist";
    case Kind::kGps:
      return "gps";
    case Kind::kNavigate:
      return "navigate";
    case Kind::kExplore:
      return "explore";
    case Kind::kReturn:
      return "return";
  }
  return "unknown";
}

const char* to_string(Event event) {
  switch (event) {
    case Event::kLanded:
      return "landed";
    case Event::kEstimateLost:
      return "estimate lost";
    case Event::kLandDemanded:
      return "a policy demands to land";
    case Event::kReturnDemanded:
      return "a policy demands to return";
    case Event::kHoverDemanded:
      return "a policy demands to stop";
    case Event::kTakeoffFailed:
      return "still on the ground at the end of the climb";
    case Event::kReferenceFinished:
      return "altitude reached";
    case Event::kReturnFailed:
      return "no way home";
    case Event::kReturned:
      return "back home";
    case Event::kNavigationFailed:
      return "navigation failed";
    case Event::kNavigationFinished:
      return "mission finished";
    case Event::kSticksSilent:
      return "remote control silent";
    case Event::kObstaclesUnseen:
      return "obstacles unseen";
  }
  return "unknown";
}

RequestRule request_rule(Mode mode, bool armed, Kind request) {
  for (const Row& row : kRows) {
    if (row.mode != mode || (mode == kGrounded && row.armed != armed)) continue;
    for (std::size_t i = 0; i < kRequestKinds.size(); ++i) {
      if (kRequestKinds[i] != request) continue;
      const Cell& cell = row.cells[i];
      return {mode,       row.armed, request, cell.answer, cell.answer == kGo ? cell.to : mode,
              cell.reason};
    }
  }
  // A value that is no enumerator: answered as on the ground, where nothing can go wrong.
  return {mode, armed, request, kRefuse, kGrounded, "unknown mode or request"};
}

const std::vector<EventRule>& event_rules() {
  static const std::vector<EventRule> rules = all_events();
  return rules;
}

}  // namespace swiftlet
