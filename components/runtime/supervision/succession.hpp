// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Decides which of several instances of one component is active, each for itself, from the signs
/// of life that they send each other.
///
/// The first in line that lives takes over when the active instance was silent for three periods.
/// Who is active stays it: a better one that comes back waits in line, so that nothing is handed
/// over without need. Where two are active (a process was stopped for a while, a network was cut),
/// the one that took over later stays, since it knows more.
///
/// DDS has exclusive ownership for this. It is not used: its readers match no writer with shared
/// ownership and the other way round, and ROS 2 asks for shared.
class Succession {
 public:
  struct Sign {
    std::string instance;  ///< unique
    int standby = 0;       ///< place in the line of succession, 0 comes first
    bool active = false;
    std::uint32_t term = 0;  ///< counts the changes of the active instance
  };

  /// Until `settle` after `begin` it does not become active, so that the others may be heard first;
  /// it need not wait once it has heard an active one.
  Succession(const Sign& self, Duration period, Duration settle, Time begin);

  void heard(const Sign& sign, Time now);
  /// True where this instance became active, or ceased to be.
  bool update(Time now);

  const Sign& self() const { return self_; }
  bool active() const { return self_.active; }

 private:
  struct Other {
    Sign sign;
    Time heard{};
  };
  /// The sign of the active instance other than this one that stays active when two are.
  const Sign* leader() const;
  bool is_next(Time now) const;

  Sign self_;
  Duration silence_;  // after which an instance counts as dead
  Time settled_;
  std::uint32_t highest_term_ = 0;
  std::map<std::string, Other> others_;  // by instance
};

}  // namespace swiftlet
