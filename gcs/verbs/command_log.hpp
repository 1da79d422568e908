// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "gcs/screen/state/event_log.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What becomes of commands, whoever gives them, from the vehicle's answers. These are repeated;
/// each is told of once. It remembers the last hundred.
class CommandLog {
 public:
  struct Told {
    screen::Severity severity = screen::Severity::kNote;
    std::string text;
  };

  /// "arm: accepted (base)" or "arm refused: why (base)", where `base` commanded; nothing where it
  /// was told of.
  std::optional<Told> hear(const swiftlet_msgs::msg::CommandAck& ack);

 private:
  std::deque<std::string> told_;
};

}  // namespace swiftlet
