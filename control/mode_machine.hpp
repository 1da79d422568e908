// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "control/mode_table.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

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
