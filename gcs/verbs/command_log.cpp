// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gcs/command/command_name.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kRemembered = 100;

CommandLog::Told outcome_of(const std::string& name, const swiftlet_msgs::msg::CommandAck& ack) {
  if (ack.accepted()) return {screen::Severity::kSuccess, name + ": accepted"};
  // Most reasons begin with "takeoff refused: ".
  const bool says_so = ack.reason().find("refused") != std::string::npos;
  return {screen::Severity::kDanger, says_so ? ack.reason() : name + " refused: " + ack.reason()};
}

}  // namespace

CommandLog::Command& CommandLog::find_or_add(const std::string& id) {
  const auto known = std::find_if(commands_.begin(), commands_.end(),
                                  [&id](const Command& command) { return command.id == id; });
  if (known != commands_.end()) return *known;
  if (commands_.size() == kRemembered) commands_.pop_front();
  Command command;
  command.id = id;
  return commands_.emplace_back(std::move(command));
}

void CommandLog::hear(const swiftlet_msgs::msg::ModeCommand& command) {
  find_or_add(command.id()).name = command_name(command.command());
}

void CommandLog::hear(const swiftlet_msgs::msg::Mission& mission) {
  const std::size_t count = mission.waypoints().size();
  find_or_add(mission.id()).name = count == 1 ? "goto" : fmt::format("{} waypoints", count);
}

void CommandLog::hear(const swiftlet_msgs::msg::CommandAck& ack, Time now) {
  Command& command = find_or_add(ack.id());
  if (command.answer) return;
  command.answer = ack;
  command.answered = now;
}

std::vector<CommandLog::Told> CommandLog::news(Time now) {
  std::vector<Told> news;
  for (Command& command : commands_) {
    if (command.is_told || !command.answer) continue;
    // RViz's goals are answered, too; they have no other name than their identity.
    if (command.name.empty() && now - command.answered < kPatience) continue;
    command.is_told = true;
    news.push_back(outcome_of(command.name.empty() ? command.id : command.name, *command.answer));
  }
  return news;
}

}  // namespace swiftlet
