// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "estimation/basics/time.hpp"
#include "gcs/screen/state/event_log.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What becomes of commands, whoever gives them, from what is heard of them on the way to the
/// vehicle and back. Commands and answers are repeated, and an answer may be heard before its
/// command; each is told of once. It remembers the last hundred.
class CommandLog {
 public:
  struct Told {
    screen::Severity severity = screen::Severity::kNote;
    std::string text;
  };
  /// An answer without its command waits so long for it, and is told of by its identity then.
  static constexpr Duration kPatience = std::chrono::milliseconds(500);

  void hear(const swiftlet_msgs::msg::ModeCommand& command);
  void hear(const swiftlet_msgs::msg::Mission& mission);
  void hear(const swiftlet_msgs::msg::CommandAck& ack, Time now);
  /// What was not told yet: "arm: accepted" or "arm refused: why".
  std::vector<Told> news(Time now);

 private:
  struct Command {
    std::string id;
    std::string name;  // "" where it was not heard
    std::optional<swiftlet_msgs::msg::CommandAck> answer;
    Time answered{};
    bool is_told = false;
  };
  Command& find_or_add(const std::string& id);

  std::deque<Command> commands_;
};

}  // namespace swiftlet
