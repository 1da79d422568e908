// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gcs/command_name.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kRemembered = 100;

}  // namespace

CommandLog::Command& CommandLog::find_or_add(const std::string& id, const std::string& name) {
  const auto known = std::find_if(commands_.begin(), commands_.end(),
                                  [&id](const Command& command) { return command.id == id; });
  if (known != commands_.end()) return *known;
  if (commands_.size() == kRemembered) commands_.pop_front();
  return commands_.emplace_back(Command{id, name});
}

void CommandLog::hear(const swiftlet_msgs::msg::ModeCommand& command) {
  (void)find_or_add(command.id(), command_name(command.command()));
}

void CommandLog::hear(const swiftlet_msgs::msg::Mission& mission) {
  const std::size_t count = mission.waypoints().size();
  (void)find_or_add(mission.id(), count == 1 ? "goto" : fmt::format("{} waypoints", count));
}

std::optional<CommandLog::Told> CommandLog::hear(const swiftlet_msgs::msg::CommandAck& ack) {
  // RViz's goals are answered, too; they have no other name.
  Command& command = find_or_add(ack.id(), ack.id());
  if (command.answered) return std::nullopt;
  command.answered = true;
  if (ack.accepted()) return Told{screen::Severity::kSuccess, command.name + ": accepted"};
  // Most reasons begin with "takeoff refused: ".
  const bool says_so = ack.reason().find("refused") != std::string::npos;
  return Told{screen::Severity::kDanger,
              says_so ? ack.reason() : command.name + " refused: " + ack.reason()};
}

}  // namespace swiftlet
