// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gcs/screen/state/key_code.hpp"

namespace swiftlet::screen {

/// What the keys mean depends on what is done with them.
enum class Keyboard {
  kFly,
  kCursor,
  kWaypoints,
  kSticks,
  kParameters,
  kText,
  kConfirm,
  kHelp,
  kEvents,
  kLink
};
inline constexpr Keyboard kKeyboards[] = {
    Keyboard::kFly,        Keyboard::kCursor, Keyboard::kWaypoints, Keyboard::kSticks,
    Keyboard::kParameters, Keyboard::kText,   Keyboard::kConfirm,   Keyboard::kHelp,
    Keyboard::kEvents,     Keyboard::kLink};
const char* to_string(Keyboard keyboard);

/// What a key does.
enum class Deed {
  kArm,
  kDisarm,
  kTakeoff,
  kLand,
  kHover,
  kReturn,
  kExplore,
  kManual,
  kAssist,
  kGoOn,
  kOpenClaw,
  kCloseClaw,
  kControl,
  kBeginCursor,
  kBeginWaypoints,
  kBeginParameters,
  kBeginEvents,
  kBeginLink,
  kGoToGlobal,
  kZoomIn,
  kZoomOut,
  kFollow,
  kShowAll,
  kUp,
  kDown,
  kLeft,
  kRight,
  kAccept,
  kLeave,
  kNext,
  kPrevious,
  kAppend,
  kInsert,
  kAppendGlobal,
  kAppendTakeoff,
  kAppendReturn,
  kAppendLanding,
  kMove,
  kHeight,
  kRemove,
  kClear,
  kEarlier,
  kLater,
  kStart,
  kSave,
  kLoad,
  kFetchMission,
  kClearMission,
  kForward,
  kBack,
  kStickLeft,
  kStickRight,
  kStickUp,
  kStickDown,
  kTurnLeft,
  kTurnRight,
  kSwitch,
  kLetGo,
  kErase,
  kEraseAll,
  kYes,
  kHelp,
  kQuit,
};

/// One row of the table of keys.
struct Binding {
  std::vector<Keyboard> keyboards;
  std::vector<KeyCode> keys;
  Deed deed;
  const char* label;      ///< the keys as they are shown
  const char* what;       ///< in two or three words
  const char* hint = "";  ///< in one, for the line at the bottom; "" is not shown there
};
/// All of them, in the order in which they are shown. A key has one meaning on a keyboard.
const std::vector<Binding>& key_bindings();
/// Null where the key means nothing there.
const Binding* find_binding(Keyboard keyboard, KeyCode key);

}  // namespace swiftlet::screen
