// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/input.h>

#include <array>
#include <map>

#include "control/steering.hpp"

namespace swiftlet {

/// Sticks from the events of a gamepad, as Linux's evdev gives them: mode 2 of remote controls, the
/// right stick for forward and left, the left one for up and turn.
class JoystickAxes {
 public:
  struct Params {
    int forward = ABS_RY;  ///< codes of the axes; pushed away from the body they go down,
    int left = ABS_RX;     ///< and to the right they go up
    int up = ABS_Y;
    int turn = ABS_X;
    int assist = BTN_SOUTH;  ///< button that switches between Manual and Assisted Manual
  };
  explicit JoystickAxes(const Params& params) : params_(params) {}

  /// What an axis says at its ends. Without it, the ends are those of a gamepad: -32768 to 32767.
  void set_range(int code, int low, int high);
  void hear(const input_event& event);
  Sticks sticks() const;

 private:
  struct Range {
    int low = -32768;
    int high = 32767;
  };
  double position(int code) const;

  Params params_;
  std::map<int, Range> ranges_;
  std::map<int, int> values_;
  bool assisted_ = false;
};

}  // namespace swiftlet
