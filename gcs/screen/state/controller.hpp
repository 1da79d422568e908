// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "control/steering.hpp"
#include "gcs/screen/state/action.hpp"
#include "gcs/screen/state/circumstances.hpp"
#include "gcs/screen/state/key_bindings.hpp"
#include "gcs/screen/state/map_keys.hpp"
#include "gcs/screen/state/mission_list.hpp"
#include "gcs/screen/state/parameter_list.hpp"
#include "gcs/sticks/key_sticks.hpp"

namespace swiftlet::screen {

/// The keyboard as a state machine: keys in, actions out. It has what a person is in the middle of:
/// which keyboard is in use, the cursor, the mission that is put together, a text that is written,
/// a question that is open, sticks that are held. Knows no terminal and no middleware.
class Controller {
 public:
  std::vector<Action> press(KeyCode key, const Circumstances& circumstances);

  Keyboard keyboard() const { return keyboard_; }
  /// The one that comes back when a question, a text or the help is done.
  Keyboard keyboard_below() const { return below_; }
  const std::optional<Eigen::Vector2d>& cursor() const { return map_.cursor(); }
  const MissionList& waypoints() const { return waypoints_; }
  /// For files, and for missions that the vehicle has.
  MissionList& waypoints() { return waypoints_; }
  const ParameterList& parameters() const { return parameters_; }
  ParameterList& parameters() { return parameters_; }
  /// Lines up from the newest, of the events that are viewed.
  int events_up() const { return events_up_; }
  /// Not farther than to the oldest, which only who draws them knows.
  void limit_events_up(int most) { events_up_ = std::min(events_up_, most); }
  MapCamera& camera() { return map_.camera(); }
  const MapCamera& camera() const { return map_.camera(); }
  /// The question or what is to be written.
  const std::string& prompt() const { return prompt_; }
  const std::string& text() const { return text_; }

  /// Asks whether an action is meant, which comes out after "yes".
  void ask(const std::string& question, Action action);

  /// Nothing where nobody flies by keys. Centred where no key came for KeySticks::kHold. Only Esc
  /// leaves them, whatever the vehicle answers: keys that somebody steers with must not turn into
  /// commands.
  std::optional<Sticks> sticks(Time now) const;

 private:
  using Actions = std::vector<Action>;
  Actions fly(Deed deed, const Circumstances& circumstances);
  Actions use_cursor(Deed deed, const Circumstances& circumstances);
  Actions edit_text(Deed deed);
  Actions accept_text();
  Actions accept_successor();
  void ask_for_global(Deed about);
  Actions accept_global();
  void view_events(Deed deed);
  Actions answer(Deed deed);
  Actions steer(Deed deed);
  Actions hover(const Circumstances& circumstances) const;
  Actions go_on(const Circumstances& circumstances) const;
  bool look(Deed deed);
  void begin_cursor(Keyboard keyboard, const Circumstances& circumstances);
  void end_cursor();
  Eigen::Vector3d place(const Circumstances& circumstances) const;
  void write(Deed about, const std::string& prompt, const std::string& text);
  void open(Keyboard keyboard);
  void close() { keyboard_ = below_; }

  // waypoint_keys.cpp
  Actions edit_waypoints(Deed deed, const Circumstances& circumstances);
  void edit_items(Deed deed, const Circumstances& circumstances);
  Actions start(const Circumstances& circumstances);
  Actions replace_list(Action action);
  Actions accept_file(Deed about);

  // parameter_keys.cpp
  void begin_parameters(const Circumstances& circumstances);
  Actions edit_parameters(Deed deed, const Circumstances& circumstances);
  Actions accept_parameter();

  Keyboard keyboard_ = Keyboard::kFly;
  Keyboard below_ = Keyboard::kFly;
  MapKeys map_;
  MissionList waypoints_;
  ParameterList parameters_;
  int events_up_ = 0;
  std::string prompt_;
  std::string text_;
  Deed about_ = Deed::kTakeoff;  // what the text is for
  std::optional<Action> asked_;  // what is done after "yes"; nothing: the list is cleared
  std::string file_;             // the name that was written last
  KeySticks key_sticks_;
};

/// How high a flight begins indoors, where nothing else is said: 4 ft in seed 004 [m].
inline constexpr double kUsualAltitude = 1.2;

}  // namespace swiftlet::screen
