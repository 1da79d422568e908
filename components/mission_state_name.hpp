// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "control/mission_runner.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// "none", "ready", "flying", "paused" or "done": the state of a MissionState as people read it.
inline std::string mission_state_name(std::uint8_t state) {
  for (const auto known :
       {MissionRunner::State::kNone, MissionRunner::State::kReady, MissionRunner::State::kFlying,
        MissionRunner::State::kPaused, MissionRunner::State::kDone}) {
    if (static_cast<std::uint8_t>(known) == state) return to_string(known);
  }
  return "a state that this program does not know";
}

/// "paused, 7 items, at item 3: hover requested".
inline std::string mission_state_text(const swiftlet_msgs::msg::MissionState& state) {
  std::string text = mission_state_name(state.state());
  if (state.count() > 0) text += ", " + std::to_string(state.count()) + " items";
  if (state.item() > 0) text += ", at item " + std::to_string(state.item());
  if (!state.reason().empty()) text += ": " + state.reason();
  return text;
}

}  // namespace swiftlet
