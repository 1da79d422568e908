// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/telemetry/health_summary.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

namespace level = diagnostic_msgs::msg::DiagnosticStatus_Constants;

/// Three times the period at which components report.
constexpr Duration kSilent = std::chrono::seconds(3);
/// More names than any vehicle has; a program that makes up new ones takes no memory.
constexpr std::size_t kMostEntries = 256;

}  // namespace

void HealthSummary::hear(const diagnostic_msgs::msg::DiagnosticArray& report, Time now) {
  for (const auto& status : report.status()) {
    if (entries_.size() >= kMostEntries && entries_.count(status.name()) == 0) continue;
    entries_[status.name()] = {std::min(status.level(), level::STALE), now};
  }
}

std::uint8_t HealthSummary::worst(Time now) const {
  if (entries_.empty()) return level::STALE;
  std::uint8_t worst = level::OK;
  for (const auto& [name, entry] : entries_) {
    worst = std::max(worst, now - entry.heard > kSilent ? level::STALE : entry.level);
  }
  return worst;
}

}  // namespace swiftlet
