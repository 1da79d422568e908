// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/qos.hpp"

#include <fmt/format.h>

namespace swiftlet {
namespace {

std::string text_of(Duration duration) {
  if (duration == kUnlimited) return "unlimited";
  return fmt::format("{:g} s", std::chrono::duration<double>(duration).count());
}

const char* text_of(Liveliness liveliness) {
  switch (liveliness) {
    case Liveliness::kAutomatic:
      return "automatic";
    case Liveliness::kByParticipant:
      return "manual by participant";
    case Liveliness::kByTopic:
      return "manual by topic";
  }
  return "unknown";
}

std::string conflict(const char* policy, const std::string& offered, const std::string& requested) {
  return fmt::format("{}: offered {}, requested {}", policy, offered, requested);
}

}  // namespace

std::string qos_conflict(const QosProfile& offered, const QosProfile& requested) {
  if (requested.reliable && !offered.reliable) {
    return conflict("reliability", "best effort", "reliable");
  }
  if (requested.transient_local && !offered.transient_local) {
    return conflict("durability", "volatile", "transient local");
  }
  if (offered.deadline > requested.deadline) {
    return conflict("deadline", text_of(offered.deadline), text_of(requested.deadline));
  }
  if (offered.liveliness < requested.liveliness) {
    return conflict("liveliness", text_of(offered.liveliness), text_of(requested.liveliness));
  }
  if (offered.lease > requested.lease) {
    return conflict("liveliness lease", text_of(offered.lease), text_of(requested.lease));
  }
  if (offered.exclusive != requested.exclusive) {
    return conflict("ownership", offered.exclusive ? "exclusive" : "shared",
                    requested.exclusive ? "exclusive" : "shared");
  }
  if (offered.latency_budget > requested.latency_budget) {
    return conflict("latency budget", text_of(offered.latency_budget),
                    text_of(requested.latency_budget));
  }
  if (requested.by_source_time && !offered.by_source_time) {
    return conflict("destination order", "by reception", "by source time");
  }
  return "";
}

}  // namespace swiftlet
