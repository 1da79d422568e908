// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

enum class Mode {
  kGrounded,
  kTakeoff,
  kHover,
  kLand,
  kManual,
  kAssistedManual,
  kGpsGuidance,
  kIndoorNavigation,
  kIndoorExploration
};
inline constexpr std::array kModes{
    Mode::kGrounded,    Mode::kTakeoff,          Mode::kHover,
    Mode::kLand,        Mode::kManual,           Mode::kAssistedManual,
    Mode::kGpsGuidance, Mode::kIndoorNavigation, Mode::kIndoorExploration};
/// As a pilot reads it: "Indoor Navigation".
const char* to_string(Mode mode);

/// What a pilot or the commander asks for.
struct Request {
  enum class Kind {
    kArm,
    kDisarm,
    kTakeoff,
    kHover,
    kLand,
    kManual,
    kAssist,
    kGps,
    kNavigate,
    kExplore,
    kReturn
  };
  Kind kind = Kind::kHover;
  double altitude = 0.0;        ///< takeoff: above the take-off point [m]
  std::uint64_t mission = 0;    ///< gps, navigate: identity of the mission, its checksum
  std::string mission_problem;  ///< gps to return: why it cannot be flown; empty if it can

  static Request arm() { return {Kind::kArm, 0.0, 0, {}}; }
  static Request disarm() { return {Kind::kDisarm, 0.0, 0, {}}; }
  static Request takeoff(double altitude) { return {Kind::kTakeoff, altitude, 0, {}}; }
  static Request hover() { return {Kind::kHover, 0.0, 0, {}}; }
  static Request land() { return {Kind::kLand, 0.0, 0, {}}; }
  static Request manual() { return {Kind::kManual, 0.0, 0, {}}; }
  static Request assist() { return {Kind::kAssist, 0.0, 0, {}}; }
  static Request gps(std::uint64_t mission, std::string problem = {}) {
    return {Kind::kGps, 0.0, mission, std::move(problem)};
  }
  static Request navigate(std::uint64_t mission, std::string problem = {}) {
    return {Kind::kNavigate, 0.0, mission, std::move(problem)};
  }
  static Request explore(std::string problem = {}) {
    return {Kind::kExplore, 0.0, 0, std::move(problem)};
  }
  static Request go_back(std::string problem = {}) {
    return {Kind::kReturn, 0.0, 0, std::move(problem)};
  }
};
inline constexpr std::array kRequestKinds{
    Request::Kind::kArm,     Request::Kind::kDisarm, Request::Kind::kTakeoff,
    Request::Kind::kHover,   Request::Kind::kLand,   Request::Kind::kManual,
    Request::Kind::kAssist,  Request::Kind::kGps,    Request::Kind::kNavigate,
    Request::Kind::kExplore, Request::Kind::kReturn};
const char* to_string(Request::Kind kind);

/// What the machine must know at each tick.
struct Situation {
  enum class Navigation { kInactive, kActive, kFinished, kFailed };
  /// What a policy asks for, from mild to strong. Each is asked for once, so that a pilot may go
  /// on.
  enum class Demand { kNone, kHover, kReturn, kLand };
  Time now{};
  bool ready = false;            ///< every check before arming holds
  std::string not_ready_reason;  ///< the culprit, where it does not
  bool estimate_ok = false;      ///< pose and velocity can be flown with
  std::string estimate_problem;  ///< where they cannot
  bool on_ground = true;
  double height = 0.0;              ///< above the take-off point [m]
  bool reference_finished = false;  ///< the vertical move of Takeoff has ended
  std::string motors_problem;       ///< why it may have failed; "" where that is not known
  std::string sticks_problem;       ///< why nobody can steer; "" where somebody can
  std::string obstacles_problem;    ///< why nothing is seen around; "" where it is
  Demand demand = Demand::kNone;
  std::string demand_reason;
  Navigation navigation = Navigation::kInactive;
  std::string navigation_problem;  ///< why it failed
};

/// A change of mode, and why.
struct Transition {
  Mode from = Mode::kGrounded;
  Mode to = Mode::kGrounded;
  std::string reason;
};
/// "Indoor Navigation -> Hover: no path to waypoint 2".
std::string describe(const Transition& transition);

/// What an accepted request did.
enum class Acceptance {
  kChanged,    ///< the mode, the mission or the arming changed
  kUnchanged,  ///< asked for already; nothing restarts
};

/// What each mode answers to each request, in one table (mode_machine.cpp, control/README.md).
struct RequestRule {
  enum class Answer { kGo, kAlready, kRefuse };
  Mode mode;
  bool armed;
  Request::Kind request;
  Answer answer;
  Mode to;             ///< kGo
  const char* reason;  ///< kRefuse: what is wrong and what to do; kAlready: what is so already
};

/// What happens by itself, in order of precedence.
struct EventRule {
  enum class Event {
    kLanded,
    kEstimateLost,
    kLandDemanded,
    kReturnDemanded,
    kHoverDemanded,
    kTakeoffFailed,
    kReferenceFinished,
    kReturnFailed,
    kReturned,
    kNavigationFailed,
    kNavigationFinished,
    kSticksSilent,
    kObstaclesUnseen
  };
  Event event;
  Mode from;
  Mode to;
};
const char* to_string(EventRule::Event event);

/// The flight modes: pure, driven by requests and by one `update` a tick.
///
/// Requests are idempotent: asked again for what is so already, the machine accepts and restarts
/// nothing. In flight it always has a safe way down: navigation that fails becomes Hover, or Land
/// where it was the way home; an estimate that is lost becomes Land.
class ModeMachine {
 public:
  struct Params {
    double min_altitude = 0.3;         ///< of a take-off [m]
    double max_altitude = 10.0;        ///< of a take-off [m]
    double landed_confirmation = 0.5;  ///< on the ground for so long is landed [s]
  };

  /// Throws std::invalid_argument where a parameter cannot be used.
  explicit ModeMachine(const Params& params);
  /// Throws std::invalid_argument, with nothing changed.
  void set_params(const Params& params);
  ModeMachine() : ModeMachine(Params{}) {}

  /// Accepts or refuses, with a reason that a pilot understands:
  /// "takeoff refused: not armed; send arm first".
  Result<Acceptance> request(const Request& request, const Situation& situation);

  /// At most one transition a tick.
  std::optional<Transition> update(const Situation& situation);

  /// All that it remembers. Whether it stands on the ground it finds out anew.
  struct State {
    Mode mode = Mode::kGrounded;
    bool armed = false;
    bool blind = false;             ///< Land without an estimate
    double takeoff_altitude = 0.0;  ///< [m]
    std::uint64_t mission = 0;
    bool returning = false;  ///< home, to land there
  };
  State state() const { return {mode_, armed_, blind_, takeoff_altitude_, mission_, returning_}; }
  void restore(const State& state);

  Mode mode() const { return mode_; }
  bool armed() const { return armed_; }
  /// Altitude of the take-off that was accepted last [m].
  double takeoff_altitude() const { return takeoff_altitude_; }
  /// Mission that Indoor Navigation or GPS Guidance flies.
  std::uint64_t mission() const { return mission_; }
  /// Whether that is the way home.
  bool returning() const { return returning_; }
  /// Land while the estimate is lost: level the vehicle and let it sink (Se3Controller::level).
  /// Should the estimate come back, so does the landing with position control.
  bool level_descent() const { return mode_ == Mode::kLand && blind_; }

  /// The tables, for documentation and tests.
  static RequestRule rule(Mode mode, bool armed, Request::Kind request);
  static const std::vector<EventRule>& event_rules();

 private:
  std::optional<Error> objection(const Request& request, const Situation& situation) const;
  Result<Acceptance> take_off_again(const Request& request, const Situation& situation) const;
  bool is_flown_already(const Request& request) const;
  bool holds(EventRule::Event event, const Situation& situation) const;
  std::string reason(EventRule::Event event, const Situation& situation) const;
  void watch_ground(const Situation& situation);

  Params params_;
  Mode mode_ = Mode::kGrounded;
  bool armed_ = false;
  bool blind_ = false;
  double takeoff_altitude_ = 0.0;
  std::uint64_t mission_ = 0;
  bool returning_ = false;
  std::optional<Time> on_ground_since_;
};

}  // namespace swiftlet
