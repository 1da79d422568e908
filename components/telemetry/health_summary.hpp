// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "diagnostic_msgs.h"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// The worst of what `diagnostics` says. Who said how well he does, and says it no more, is STALE.
class HealthSummary {
 public:
  void hear(const diagnostic_msgs::msg::DiagnosticArray& report, Time now);
  /// As in DiagnosticStatus; STALE where nobody said anything yet.
  std::uint8_t worst(Time now) const;

 private:
  struct Entry {
    std::uint8_t level = 0;
    Time heard{};
  };
  std::map<std::string, Entry> entries_;  // by the status' name
};

}  // namespace swiftlet
