// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "estimation/basics/time.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Who is on board and how they are, from their signs of life: what must be known before arming,
/// and while others are relied on.
class Attendance {
 public:
  /// A sign of life, which says nothing of problems.
  void heard_alive(const swiftlet_msgs::msg::ComponentStatus& sign, Time now);
  void heard_status(const swiftlet_msgs::msg::ComponentStatus& status, Time now);

  /// Those that were not heard for long are no problem any more, until they are heard again: to be
  /// called on the ground.
  void forget_who_left(Time now);

  /// What keeps any component from working, or that one fell silent: "estimator: phone/pose: nobody
  /// writes it". "" where all is well.
  std::string problem(Time now) const;
  /// That a component without which nothing can be flown has not said how it is; only its status
  /// tells that it hears what is sent to it. "" where it has.
  std::string absence(const std::string& component, Time now) const;
  /// The same of one component that is relied on in flight, if it was ever there: that it is
  /// silent, or blocked for a while. An instance that stands by has the time to take over, also one
  /// of whoever should write what blocks it.
  std::string failure(const std::string& component, Time now) const;
  /// The same of several: who is silent before who is blocked, since one explains the other.
  template <class Names>
  std::string failure_of_any(const Names& components, Time now) const {
    for (const bool only_silent : {true, false}) {
      for (const char* component : components) {
        std::string failure = failure_of(component, only_silent, now);
        if (!failure.empty()) return failure;
      }
    }
    return "";
  }

 private:
  std::string failure_of(const std::string& component, bool only_silent, Time now) const;

  struct Instance {
    swiftlet_msgs::msg::ComponentStatus status;  // with the problems that were reported last
    Time heard{};
    std::optional<Time> blocked_since;
    bool forgotten = false;
  };
  using Instances = std::map<std::string, Instance>;
  /// The active one; of several that live the one that took over last, else the one heard last.
  static const Instance* leader(const Instances& instances, Time now);

  std::map<std::string, Instances> components_;  // instances by their identity
};

}  // namespace swiftlet
