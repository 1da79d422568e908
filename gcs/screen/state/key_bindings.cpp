// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/key_bindings.hpp"

#include <algorithm>

namespace swiftlet::screen {
namespace {

constexpr KeyCode k(char character) {
  return key_code(static_cast<unsigned char>(character));
}

bool has(const std::vector<Keyboard>& keyboards, Keyboard keyboard) {
  return std::find(keyboards.begin(), keyboards.end(), keyboard) != keyboards.end();
}

std::vector<Binding> make_bindings() {
  const std::vector<Keyboard> fly{Keyboard::kFly};
  const std::vector<Keyboard> cursor{Keyboard::kCursor};
  const std::vector<Keyboard> list{Keyboard::kWaypoints};
  const std::vector<Keyboard> sticks{Keyboard::kSticks};
  const std::vector<Keyboard> map{Keyboard::kFly, Keyboard::kCursor, Keyboard::kWaypoints};
  const std::vector<Keyboard> places{Keyboard::kCursor, Keyboard::kWaypoints};
  return {
      {fly, {k('a')}, Deed::kArm, "a", "arm (asks)", "arm"},
      {fly, {k('d')}, Deed::kDisarm, "d", "disarm"},
      {fly, {k('t')}, Deed::kTakeoff, "t", "take off (asks how high)", "take off"},
      {fly, {k('l')}, Deed::kLand, "l", "land here", "land"},
      {fly, {k('h')}, Deed::kHover, "h", "hover"},
      {map, {k(' ')}, Deed::kHover, "space", "pause: hover at once", "pause"},
      {map, {k('u')}, Deed::kGoOn, "u", "go on with the mission"},
      {fly, {k('r')}, Deed::kReturn, "r", "return and land", "return"},
      {fly, {k('e')}, Deed::kExplore, "e", "explore"},
      {fly, {k('m')}, Deed::kManual, "m", "manual: fly by keys"},
      {fly, {k('n')}, Deed::kAssist, "n", "assisted manual"},
      {fly, {k('g')}, Deed::kBeginCursor, "g", "fly to a place in the map", "go to"},
      {fly, {k('G')}, Deed::kGoToGlobal, "G", "on Earth: fly to a place"},
      {fly, {k('w')}, Deed::kBeginWaypoints, "w", "waypoints", "waypoints"},
      {fly, {k('o')}, Deed::kOpenClaw, "o", "open claw (asks in flight)"},
      {fly, {k('c')}, Deed::kCloseClaw, "c", "close claw"},
      {fly, {k('p')}, Deed::kBeginParameters, "p", "parameters"},
      {fly, {k('v')}, Deed::kBeginEvents, "v", "view all events"},
      {fly, {k('b')}, Deed::kBeginLink, "b", "budget of the link"},
      {fly, {k('k')}, Deed::kControl, "k", "control: take it, or give it away"},

      {cursor, {KeyCode::kEnter}, Deed::kAccept, "Enter", "fly there", "fly there"},
      {list, {k('a'), KeyCode::kEnter}, Deed::kAppend, "a Enter", "add at the cursor", "add"},
      {list, {k('i')}, Deed::kInsert, "i", "insert before the selected"},
      {list, {k('t')}, Deed::kAppendTakeoff, "t", "take-off, in front"},
      {list, {k('G')}, Deed::kAppendGlobal, "G", "add a place on Earth"},
      {list, {k('r')}, Deed::kAppendReturn, "r", "return, at the end"},
      {list, {k('l')}, Deed::kAppendLanding, "l", "landing, at the end"},
      {list, {k('m')}, Deed::kMove, "m", "move the selected here", "move"},
      {list, {k('z')}, Deed::kHeight, "z", "height of the selected"},
      {list, {k('x'), KeyCode::kDelete}, Deed::kRemove, "x Del", "remove the selected", "remove"},
      {list, {k('c')}, Deed::kClear, "c", "clear all (asks)"},
      {list, {k('n'), KeyCode::kTab}, Deed::kNext, "n Tab", "select the next", "next"},
      {list, {k('b'), KeyCode::kBackTab}, Deed::kPrevious, "b", "select the one before"},
      {list, {k('[')}, Deed::kEarlier, "[", "fly it earlier"},
      {list, {k(']')}, Deed::kLater, "]", "fly it later"},
      {list, {k('s')}, Deed::kStart, "s", "start: upload, and fly it", "start"},
      {list, {k('o')}, Deed::kLoad, "o", "open a file", "open"},
      {list, {k('w')}, Deed::kSave, "w", "write a file", "write"},
      {list, {k('d')}, Deed::kFetchMission, "d", "download the vehicle's"},
      {list, {k('v')}, Deed::kClearMission, "v", "clear the vehicle's (asks)"},

      {sticks, {k('w')}, Deed::kForward, "w", "forward"},
      {sticks, {k('s')}, Deed::kBack, "s", "back"},
      {sticks, {k('a')}, Deed::kStickLeft, "a", "left"},
      {sticks, {k('d')}, Deed::kStickRight, "d", "right"},
      {sticks, {k('i')}, Deed::kStickUp, "i", "up"},
      {sticks, {k('k')}, Deed::kStickDown, "k", "down"},
      {sticks, {k('j')}, Deed::kTurnLeft, "j", "turn left"},
      {sticks, {k('l')}, Deed::kTurnRight, "l", "turn right"},
      {sticks, {k('m')}, Deed::kSwitch, "m", "Manual or Assisted Manual"},
      {sticks, {k(' ')}, Deed::kLetGo, "space", "let go of the sticks", "let go"},

      {{Keyboard::kParameters},
       {KeyCode::kEnter},
       Deed::kAccept,
       "Enter",
       "open, or change",
       "open"},
      {{Keyboard::kText}, {KeyCode::kEnter}, Deed::kAccept, "Enter", "that is it", "done"},
      {{Keyboard::kText}, {KeyCode::kBackspace}, Deed::kErase, "Backspace", "one back"},
      {{Keyboard::kText}, {KeyCode::kEraseLine}, Deed::kEraseAll, "Ctrl-U", "erase all of it"},
      {{Keyboard::kConfirm}, {k('y')}, Deed::kYes, "y", "yes"},

      {map, {k('+'), k('=')}, Deed::kZoomIn, "+", "zoom in"},
      {map, {k('-')}, Deed::kZoomOut, "-", "zoom out"},
      {map, {k('f')}, Deed::kFollow, "f", "follow the vehicle"},
      {map, {k('0')}, Deed::kShowAll, "0", "show all of the map"},
      {fly, {KeyCode::kLeft}, Deed::kLeft, "←", "look to the west"},
      {fly, {KeyCode::kRight}, Deed::kRight, "→", "look to the east"},
      {fly, {KeyCode::kUp}, Deed::kUp, "↑", "look to the north"},
      {fly, {KeyCode::kDown}, Deed::kDown, "↓", "look to the south"},
      {places, {KeyCode::kLeft}, Deed::kLeft, "←", "cursor to the west"},
      {places, {KeyCode::kRight}, Deed::kRight, "→", "cursor to the east"},
      {places, {KeyCode::kUp}, Deed::kUp, "↑", "cursor to the north"},
      {places, {KeyCode::kDown}, Deed::kDown, "↓", "cursor to the south"},
      {{Keyboard::kParameters}, {KeyCode::kUp}, Deed::kUp, "↑", "the line above"},
      {{Keyboard::kParameters}, {KeyCode::kDown}, Deed::kDown, "↓", "the line below"},
      {{Keyboard::kEvents}, {KeyCode::kUp}, Deed::kUp, "↑", "earlier", "earlier"},
      {{Keyboard::kEvents}, {KeyCode::kDown}, Deed::kDown, "↓", "later", "later"},
      {{Keyboard::kCursor, Keyboard::kWaypoints, Keyboard::kParameters, Keyboard::kText,
        Keyboard::kEvents, Keyboard::kLink},
       {KeyCode::kEscape},
       Deed::kLeave,
       "Esc",
       "back",
       "back"},
      {sticks, {KeyCode::kEscape}, Deed::kLeave, "Esc", "leave, and hover", "leave"},
      {{Keyboard::kConfirm}, {k('n'), KeyCode::kEscape}, Deed::kLeave, "n Esc", "no"},
      {{Keyboard::kHelp},
       {KeyCode::kEscape, KeyCode::kEnter, k('?'), k('q'), k(' ')},
       Deed::kLeave,
       "Esc ?",
       "close the help"},
      {{Keyboard::kFly, Keyboard::kCursor, Keyboard::kWaypoints, Keyboard::kParameters},
       {k('?')},
       Deed::kHelp,
       "?",
       "help"},
      {fly, {k('q')}, Deed::kQuit, "q", "quit (asks in flight)"},
  };
}

}  // namespace

const char* to_string(Keyboard keyboard) {
  switch (keyboard) {
    case Keyboard::kFly:
      return "Keys";
    case Keyboard::kCursor:
      return "Go to";
    case Keyboard::kWaypoints:
      return "Waypoints";
    case Keyboard::kSticks:
      return "Fly by keys";
    case Keyboard::kParameters:
      return "Parameters";
    case Keyboard::kText:
      return "Entry";
    case Keyboard::kConfirm:
      return "Question";
    case Keyboard::kHelp:
      return "Help";
    case Keyboard::kEvents:
      return "Events";
    case Keyboard::kLink:
      return "Link";
  }
  return "";
}

const std::vector<Binding>& key_bindings() {
  static const std::vector<Binding> bindings = make_bindings();
  return bindings;
}

const Binding* find_binding(Keyboard keyboard, KeyCode key) {
  for (const Binding& binding : key_bindings()) {
    const auto& keys = binding.keys;
    if (has(binding.keyboards, keyboard) &&
        std::find(keys.begin(), keys.end(), key) != keys.end()) {
      return &binding;
    }
  }
  return nullptr;
}

}  // namespace swiftlet::screen
