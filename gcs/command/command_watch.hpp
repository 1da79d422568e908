// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/terminal/terminal.hpp"
#include "components/topics.hpp"
#include "gcs/command/command_client.hpp"

namespace swiftlet {

/// Whether what was commanded has come to its end, by what the vehicle says afterwards. A take-off
/// is done in Hover, a flight to a place when it is there, a landing on the ground; one that ends
/// otherwise has failed, with the vehicle's reason.
class CommandWatch {
 public:
  /// `id` is what a CommandSender sent it with.
  CommandWatch(const GroundCommand& command, const std::string& id) : command_(command), id_(id) {}

  /// Of statuses that were sent after the command was accepted. Nothing while it is under way.
  std::optional<CommandOutcome> hear(const swiftlet_msgs::msg::VehicleStatus& status) const;
  /// The same for commands about the uploaded mission, which no other may be asked of.
  std::optional<CommandOutcome> hear(const swiftlet_msgs::msg::MissionState& state) const;
  /// The same for commands about the claw.
  std::optional<CommandOutcome> hear(const swiftlet_msgs::msg::ClawState& state) const;

 private:
  CommandOutcome done(const std::string& how) const;
  CommandOutcome failed(const std::string& reason) const;

  GroundCommand command_;
  std::string id_;
};

/// Listens until what was commanded is done (0) or has failed (1), and says how far it is. A
/// vehicle that is not heard for ten seconds is lost: 1.
class WaitClient : public Component {
 public:
  WaitClient(const ComponentContext& context, const GroundCommand& command, const std::string& id,
             Terminal& terminal);
  const CommandOutcome& outcome() const { return outcome_; }

 private:
  void advance(Time now);
  void take(const std::optional<CommandOutcome>& outcome);

  CommandWatch watch_;
  Terminal& terminal_;
  Time heard_;
  std::optional<swiftlet_msgs::msg::VehicleStatus> status_;
  std::optional<swiftlet_msgs::msg::MissionState> mission_;
  CommandOutcome outcome_;
};

}  // namespace swiftlet
