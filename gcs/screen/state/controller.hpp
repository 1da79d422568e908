// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/steering.hpp"
#include "gcs/key_sticks.hpp"
#include "gcs/screen/state/key_bindings.hpp"
#include "gcs/screen/state/map_camera.hpp"
#include "gcs/screen/state/parameter_list.hpp"
#include "gcs/screen/state/waypoint_list.hpp"

namespace swiftlet::screen {

/// What a person asked for by keys.
struct Action {
  enum class Kind {
    kArm,
    kDisarm,
    kTakeoff,
    kLand,
    kHover,
    kReturn,
    kExplore,
    kManual,
    kAssist,
    kMission,
    kListParameters,
    kSetParameter,
    kQuit,
  };
  Kind kind = Kind::kHover;
  double altitude = 0.0;                     ///< kTakeoff: above the take-off point [m]
  std::string name;                          ///< kMission: as it is shown; else of a parameter
  std::vector<MissionWaypoint> waypoints{};  ///< kMission
  std::string component{};                   ///< of parameters
  std::string value{};                       ///< kSetParameter, as in YAML
};

/// What keys depend on.
struct Circumstances {
  Time now{};
  bool in_flight = false;
  std::optional<Eigen::Vector3d> vehicle;  ///< in the map [m]
  std::vector<std::string> components;     ///< that have parameters
};

/// The keyboard as a state machine: keys in, actions out. It has what a person is in the middle of:
/// which keyboard is in use, the cursor, the list of waypoints, a text that is written, a question
/// that is open, sticks that are held. Knows no terminal and no middleware.
class Controller {
 public:
  std::vector<Action> press(KeyCode key, const Circumstances& circumstances);

  Keyboard keyboard() const { return keyboard_; }
  /// The one that comes back when a question, a text or the help is done.
  Keyboard keyboard_below() const { return below_; }
  const std::optional<Eigen::Vector2d>& cursor() const { return cursor_; }
  const WaypointList& waypoints() const { return waypoints_; }
  /// For files, and for missions that the vehicle has.
  WaypointList& waypoints() { return waypoints_; }
  const ParameterList& parameters() const { return parameters_; }
  ParameterList& parameters() { return parameters_; }
  MapCamera& camera() { return camera_; }
  const MapCamera& camera() const { return camera_; }
  /// The question or what is to be written.
  const std::string& prompt() const { return prompt_; }
  const std::string& text() const { return text_; }

  /// Nothing where nobody flies by keys. Centred where no key came for KeySticks::kHold. Only Esc
  /// leaves them, whatever the vehicle answers: keys that somebody steers with must not turn into
  /// commands.
  std::optional<Sticks> sticks(Time now) const;

 private:
  using Actions = std::vector<Action>;
  Actions fly(Deed deed, const Circumstances& circumstances);
  Actions use_cursor(Deed deed, const Circumstances& circumstances);
  Actions edit_waypoints(Deed deed, const Circumstances& circumstances);
  Actions edit_parameters(Deed deed, const Circumstances& circumstances);
  Actions accept_text(const Circumstances& circumstances);
  Actions steer(Deed deed);
  bool look(Deed deed);
  void begin_cursor(Keyboard keyboard, const Circumstances& circumstances);
  void move_cursor(Deed deed);
  Eigen::Vector3d place(const Circumstances& circumstances) const;
  void ask(const std::string& question, Action action);
  void write(Deed about, const std::string& prompt, const std::string& text);
  void open(Keyboard keyboard);
  void close() { keyboard_ = below_; }

  Keyboard keyboard_ = Keyboard::kFly;
  Keyboard below_ = Keyboard::kFly;
  std::optional<Eigen::Vector2d> cursor_;
  WaypointList waypoints_;
  ParameterList parameters_;
  MapCamera camera_;
  std::string prompt_;
  std::string text_;
  Deed about_ = Deed::kTakeoff;  // what the text is for
  Action asked_;                 // what is done after "yes"
  bool asked_to_clear_ = false;
  KeySticks key_sticks_;
};

/// How high a flight begins indoors, where nothing else is said: 4 ft in seed 004 [m].
inline constexpr double kUsualAltitude = 1.2;

}  // namespace swiftlet::screen
