// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "gcs/screen/state/event_log.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What becomes of commands, whoever gives them, from what is heard of them on the way to the
/// vehicle and back. Commands and answers are repeated; each is told of once. It remembers the last
/// hundred.
class CommandLog {
 public:
  struct Told {
    screen::Severity severity = screen::Severity::kNote;
    std::string text;
  };

  void hear(const swiftlet_msgs::msg::ModeCommand& command);
  void hear(const swiftlet_msgs::msg::Mission& mission);
  /// "arm: accepted" or "arm refused: why"; nothing where that was told already.
  std::optional<Told> hear(const swiftlet_msgs::msg::CommandAck& ack);

 private:
  struct Command {
    std::string id;
    std::string name;
    bool answered = false;
  };
  Command& find_or_add(const std::string& id, const std::string& name);

  std::deque<Command> commands_;
};

}  // namespace swiftlet
