// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/attendance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace swiftlet {
namespace {

constexpr double kSilentPeriods = 3.0;
/// A successor takes over after three periods, and needs some time to be heard.
constexpr double kSilentPeriodsWithStandby = 7.0;
/// Silences that a busy machine has are nobody's death [s].
constexpr double kShortestSilence = 0.1;
/// For so long a component may be blocked: what it misses is back when a successor has taken over,
/// and where there is none, whoever fell silent is the better reason [s].
constexpr double kBlocked = 0.5;
/// Status comes five times a second [s].
constexpr double kSilentStatus = 1.0;
/// Who was not heard for so long has left [s].
constexpr double kGone = 10.0;

bool silent(const swiftlet_msgs::msg::ComponentStatus& status, double age, double periods) {
  return age > std::max(periods * status.period(), kShortestSilence);
}

}  // namespace

void Attendance::heard_alive(const swiftlet_msgs::msg::ComponentStatus& sign, Time now) {
  Instance& instance = components_[sign.component_name()][sign.instance()];
  instance.heard = now;
  instance.forgotten = false;
  instance.status.period(sign.period());
  instance.status.active(sign.active());
  instance.status.term(sign.term());
}

void Attendance::heard_status(const swiftlet_msgs::msg::ComponentStatus& status, Time now) {
  Instance& instance = components_[status.component_name()][status.instance()];
  const Time since = instance.blocked_since.value_or(now);
  instance = {status, now, status.blocked() ? std::optional(since) : std::nullopt, false};
}

const Attendance::Instance* Attendance::leader(const Instances& instances, Time now) {
  // One that was killed goes on being the active one by its own last word.
  const auto rank = [now](const Instance& instance) {
    const bool is_silent =
        silent(instance.status, to_seconds(now - instance.heard), kSilentPeriods);
    return std::tuple(!is_silent, is_silent ? 0 : instance.status.term(), instance.heard);
  };
  const Instance* leader = nullptr;
  for (const auto& [identity, instance] : instances) {
    if (!instance.status.active()) continue;
    if (leader == nullptr || rank(*leader) < rank(instance)) leader = &instance;
  }
  return leader;
}

void Attendance::forget_who_left(Time now) {
  for (auto& [component, instances] : components_) {
    for (auto& [identity, instance] : instances) {
      if (to_seconds(now - instance.heard) > kGone) instance.forgotten = true;
    }
  }
}

std::string Attendance::problem(Time now) const {
  for (const auto& [component, instances] : components_) {
    const Instance* active = leader(instances, now);
    if (active == nullptr || active->forgotten) continue;
    const double age = to_seconds(now - active->heard);
    if (age > kSilentStatus) {
      return fmt::format("{}: silent for {:.1f} s; does its process live?", component, age);
    }
    if (!active->status.problems().empty()) {
      return fmt::format("{}: {}", component, active->status.problems().front());
    }
  }
  return "";
}

std::string Attendance::absence(const std::string& component, Time now) const {
  const auto found = components_.find(component);
  const Instance* active = found == components_.end() ? nullptr : leader(found->second, now);
  if (active != nullptr && to_seconds(now - active->heard) <= kSilentStatus) return "";
  return fmt::format("{}: has not said how it is; does it run, and is this host heard there?",
                     component);
}

std::string Attendance::failure(const std::string& component, Time now) const {
  return failure_of(component, false, now);
}

std::string Attendance::failure_of(const std::string& component, bool only_silent, Time now) const {
  const auto found = components_.find(component);
  const Instance* active = found == components_.end() ? nullptr : leader(found->second, now);
  if (active == nullptr) return "";
  const double age = to_seconds(now - active->heard);
  const bool has_standby =
      std::any_of(found->second.begin(), found->second.end(), [now](const auto& entry) {
        const Instance& instance = entry.second;
        return !instance.status.active() &&
               !silent(instance.status, to_seconds(now - instance.heard), kSilentPeriods);
      });
  if (silent(active->status, age, has_standby ? kSilentPeriodsWithStandby : kSilentPeriods)) {
    return fmt::format("the {} fell silent {:.2f} s ago", component, age);
  }
  const bool is_blocked =
      !only_silent && active->blocked_since && to_seconds(now - *active->blocked_since) > kBlocked;
  if (is_blocked && !active->status.problems().empty()) {
    return fmt::format("the {} cannot work: {}", component, active->status.problems().front());
  }
  return "";
}

}  // namespace swiftlet
