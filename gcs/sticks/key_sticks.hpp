// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "components/terminal/terminal.hpp"
#include "control/steering.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Keys as sticks: a stick stays where a key has put it while the key repeats, and goes back to its
/// centre soon after. A terminal does not tell when a key is let go; what is not pressed again
/// within `kHold` counts as let go.
class KeySticks {
 public:
  static constexpr Duration kHold = std::chrono::milliseconds(600);
  explicit KeySticks(bool assisted = false) : assisted_(assisted) {}

  /// w s: forward and back; a d: left and right; i k: up and down; j l: turn left and right; m: the
  /// switch between Manual and Assisted Manual; anything else: all sticks to their centres.
  void press(Key key, Time now);
  Sticks at(Time now) const;

 private:
  struct Stick {
    double value = 0.0;
    Time pressed{};
  };
  std::array<Stick, 4> sticks_;  // forward, left, up, turn
  bool assisted_;
};

}  // namespace swiftlet
