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
  /// Sticks that are out of their middle by no more are not moved [share of full deflection].
  void set_dead_band(double dead_band) { dead_band_ = dead_band; }

  /// Whether a command of this station is to be carried out.
  Status admit(const std::string& station, Time now);
  /// Whether these sticks steer. The vehicle's own remote control, which has no name, always may;
  /// those of a station take control when they are moved. Of two that may, the one that is moved
  /// does, and of two that are moved the remote control.
  bool admit_sticks(const swiftlet_msgs::msg::ManualControl& sticks, Time now);
  /// Carries out what is about control itself, for which a station need not have been admitted;
  /// nothing where it is another command.
  std::optional<Result<Acceptance>> carry_out(const swiftlet_msgs::msg::ModeCommand& command,
                                              Time now);

  /// What a heartbeat says of the link to who has control, or to anybody where nobody has; who gave
  /// it counts until the other is heard.
  enum class Link {
    kOfOthers,  ///< nothing: who only looks is no link, and who promises nothing is not missed
    kHeard,     ///< from now on it is missed where it falls silent
    kLeft,      ///< not any more
  };
  Link hear(const swiftlet_msgs::msg::ComponentStatus& heartbeat, Time now);
  /// Whether the link was heard of another station than the one that has control by now: that one
  /// has never been there to be missed.
  bool link_is_of_others(Time now) const;

  /// "" where no station has control.
  const std::string& holder(Time now) const { return authority_.holder(now); }

  /// For a standby.
  void write(swiftlet_msgs::msg::CommanderState& state) const;
  void restore(const swiftlet_msgs::msg::CommanderState& state);

 private:
  /// Who gave control to a station that was not heard since, and is a link until then.
  std::string giver(Time now) const;

  struct Steering {
    std::string name;
    bool moved = false;
    Time heard{};
  };

  CommandAuthority authority_;
  double dead_band_ = 0.05;
  std::optional<Steering> steering_;
  std::string linked_;  // whose link was heard last
};

}  // namespace swiftlet
