// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/command/command_sender.hpp"

namespace swiftlet {

/// Sends one command of a station until it is acknowledged or `patience` is over; then it ends the
/// run.
class CommandClient : public Component {
 public:
  CommandClient(const ComponentContext& context, const std::string& station,
                const GroundCommand& command, Duration patience);

  const CommandOutcome& outcome() const { return outcome_; }
  const std::string& command_id() const { return sender_.id(); }

 private:
  CommandSender sender_;
  CommandOutcome outcome_;
};

}  // namespace swiftlet
