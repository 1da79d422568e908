// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "swiftlet_msgs.h"

namespace swiftlet {

/// What commands were answered last, so that one that comes again, for its answer was lost on the
/// way, is not carried out again.
class AnsweredCommands {
 public:
  static constexpr std::size_t kMost = 64;  ///< then the oldest is forgotten

  /// The answer to the command of this id; nullptr where it is new.
  const swiftlet_msgs::msg::CommandAck* find(const std::string& id) const;
  const swiftlet_msgs::msg::CommandAck& add(swiftlet_msgs::msg::CommandAck answer);

  /// For a standby.
  void write(swiftlet_msgs::msg::CommanderState& state) const;
  void restore(const swiftlet_msgs::msg::CommanderState& state);

 private:
  std::deque<swiftlet_msgs::msg::CommandAck> answers_;
};

}  // namespace swiftlet
