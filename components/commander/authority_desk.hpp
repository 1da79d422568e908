// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/runtime/config/config.hpp"
#include "control/command_authority.hpp"
#include "control/mode_machine.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// A CommandAuthority as ground stations see it. Who gives no name is a station called "unnamed".
class AuthorityDesk {
 public:
  explicit AuthorityDesk(Duration lease) : authority_(lease) {}
  /// `control_lease` [s] of a commander's section. Throws ConfigError.
  static Duration read_lease(const Config& config);
  void set_lease(Duration lease) { authority_.set_lease(lease); }

  /// Whether a command of this station is to be carried out.
  Status admit(const std::string& station, Time now);
  /// Whether these sticks steer. The vehicle's own remote control, which has no name, always does;
  /// those of a station take control when they are moved.
  bool admit_sticks(const swiftlet_msgs::msg::ManualControl& sticks, Time now);
  /// Carries out what is about control itself, for which a station need not have been admitted;
  /// nothing where it is another command.
  std::optional<Result<Acceptance>> carry_out(const swiftlet_msgs::msg::ModeCommand& command,
                                              Time now);
  void hear(const swiftlet_msgs::msg::ComponentStatus& heartbeat, Time now);

  /// Whether it is that of who has control, or nobody has.
  bool is_of_holder(const swiftlet_msgs::msg::ComponentStatus& heartbeat, Time now) const;

  /// "" where no station has control.
  const std::string& holder(Time now) const { return authority_.holder(now); }

  /// For a standby.
  void write(swiftlet_msgs::msg::CommanderState& state) const;
  void restore(const swiftlet_msgs::msg::CommanderState& state);

 private:
  CommandAuthority authority_;
};

}  // namespace swiftlet
