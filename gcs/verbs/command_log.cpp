// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_log.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

constexpr std::size_t kRemembered = 100;

CommandLog::Told outcome_of(const swiftlet_msgs::msg::CommandAck& ack) {
  const std::string& name = ack.name().empty() ? ack.id() : ack.name();
  const std::string from = ack.station().empty() ? "" : " (" + ack.station() + ")";
  if (ack.accepted()) return {screen::Severity::kSuccess, name + ": accepted" + from};
  // Most reasons begin with "takeoff refused: ".
  const std::string before =
      ack.reason().rfind(name + " refused", 0) == 0 ? "" : name + " refused: ";
  return {screen::Severity::kDanger, before + ack.reason() + from};
}

}  // namespace

std::optional<CommandLog::Told> CommandLog::hear(const swiftlet_msgs::msg::CommandAck& ack) {
  if (std::find(told_.begin(), told_.end(), ack.id()) != told_.end()) return std::nullopt;
  told_.push_back(ack.id());
  if (told_.size() > kRemembered) told_.pop_front();
  return outcome_of(ack);
}

}  // namespace swiftlet
