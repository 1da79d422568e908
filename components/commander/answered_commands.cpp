// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/answered_commands.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {

const swiftlet_msgs::msg::CommandAck* AnsweredCommands::find(const std::string& id) const {
  const auto known = std::find_if(answers_.begin(), answers_.end(),
                                  [&](const auto& answer) { return answer.id() == id; });
  return known == answers_.end() ? nullptr : &*known;
}

const swiftlet_msgs::msg::CommandAck& AnsweredCommands::add(swiftlet_msgs::msg::CommandAck answer) {
  answers_.push_back(std::move(answer));
  if (answers_.size() > kMost) answers_.pop_front();
  return answers_.back();
}

void AnsweredCommands::write(swiftlet_msgs::msg::CommanderState& state) const {
  state.answered().assign(answers_.begin(), answers_.end());
}

void AnsweredCommands::restore(const swiftlet_msgs::msg::CommanderState& state) {
  answers_.assign(state.answered().begin(), state.answered().end());
}

}  // namespace swiftlet
