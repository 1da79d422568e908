// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/health_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace swiftlet {
namespace {

using Level = FlightEvent::Level;

/// Diagnostics come about once a second.
constexpr double kLongestGap = 5.0;
/// Of a battery no more is integrated over a gap than this [s].
constexpr double kLongestBatteryGap = 10.0;

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

std::optional<double> number_at(const diagnostic_msgs::msg::DiagnosticStatus& status,
                                const std::string& key) {
  for (const diagnostic_msgs::msg::KeyValue& entry : status.values()) {
    if (entry.key() != key) continue;
    char* end = nullptr;
    const double value = std::strtod(entry.value().c_str(), &end);
    const bool is_number = end != entry.value().c_str() && *end == '\0' && std::isfinite(value);
    return is_number ? std::make_optional(value) : std::nullopt;
  }
  return std::nullopt;
}

const char* name_of(std::uint8_t level) {
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  return level == OK ? "OK" : level == WARN ? "WARN" : level == STALE ? "STALE" : "ERROR";
}

}  // namespace

void HealthReader::on_battery(double time, const sensor_msgs::msg::BatteryState& message) {
  FlightCurves& curves = story_.curves;
  const double voltage = message.voltage(), current = message.current();
  const double percentage = 100.0 * message.percentage();
  curves.battery_percentage.add(time, percentage);
  curves.battery_voltage.add(time, voltage);
  // Negative while the battery is emptied, as sensor_msgs/BatteryState has it; not all say so.
  curves.battery_current.add(time, current);
  auto& use = story_.figures.battery;
  if (!use) use.emplace();
  if (std::isfinite(percentage)) {
    if (!use->first_percentage) use->first_percentage = percentage;
    use->last_percentage = percentage;
  }
  if (std::isfinite(voltage)) {
    use->lowest_voltage = std::min(use->lowest_voltage.value_or(voltage), voltage);
  }
  if (last_battery_ && std::isfinite(voltage * current)) {
    const double step = std::clamp(time - *last_battery_, 0.0, kLongestBatteryGap);
    use->energy += std::abs(voltage * current) * step / 3600.0;
  }
  last_battery_ = time;
}

void HealthReader::on_diagnostics(double time,
                                  const diagnostic_msgs::msg::DiagnosticArray& message) {
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  for (const diagnostic_msgs::msg::DiagnosticStatus& status : message.status()) {
    note_consistency(time, status);
    Said& said = diagnostics_[status.name()];
    const bool is_news =
        status.level() != said.level || (status.level() != OK && status.message() != said.message);
    if (is_news) {
      const Level level = status.level() == OK     ? Level::kInfo
                          : status.level() == WARN ? Level::kWarning
                                                   : Level::kError;
      story_.events.add(time, level, "diagnostics",
                        fmt::format("{}: {}{}{}", status.name(), name_of(status.level()),
                                    status.message().empty() ? "" : ", ", status.message()));
    }
    said = {status.level(), status.message()};
  }
}

void HealthReader::note_consistency(double time,
                                    const diagnostic_msgs::msg::DiagnosticStatus& status) {
  constexpr std::string_view kMean = "_mean";
  for (const diagnostic_msgs::msg::KeyValue& entry : status.values()) {
    const std::string& key = entry.key();
    if (!ends_with(key, "nis_mean") && !ends_with(key, "nees_mean")) continue;
    const std::string stem = key.substr(0, key.size() - kMean.size());
    const auto value = number_at(status, key);
    const auto low = number_at(status, stem + "_95_percent_low");
    const auto high = number_at(status, stem + "_95_percent_high");
    if (!value || !low || !high || *value <= 0.0) continue;  // 0: there was nothing to judge
    const std::string name = status.name() + ": " + key;
    auto& all = story_.curves.consistencies;
    auto found = std::find_if(all.begin(), all.end(),
                              [&name](const Consistency& known) { return known.name == name; });
    if (found == all.end()) {
      const ThinnedCurve empty(duration_, kLongestGap);
      found = all.insert(all.end(), Consistency{name, empty, empty, empty});
    }
    found->value.add(time, *value);
    found->low.add(time, *low);
    found->high.add(time, *high);
    found->sum += *value;
    ++found->count;
    if (*value >= *low && *value <= *high) ++found->inside;
  }
}

void HealthReader::on_component(double time, const swiftlet_msgs::msg::ComponentStatus& message) {
  const std::string& name = message.component_name();
  if (message.active()) {
    std::string& active = active_[name];
    if (!active.empty() && active != message.instance()) {
      story_.events.add(time, Level::kWarning, "component",
                        fmt::format("{}: the instance in process {} took over (term {})", name,
                                    message.process(), message.term()));
    }
    active = message.instance();
  }
  std::set<std::string>& known = problems_[name + " in " + message.process()];
  const std::set<std::string> now(message.problems().begin(), message.problems().end());
  for (const std::string& problem : now) {
    if (known.count(problem) > 0) continue;
    story_.events.add(
        time, message.blocked() ? Level::kError : Level::kWarning, "component",
        fmt::format("{}: {}{}", name, problem, message.blocked() ? "; it cannot do its work" : ""));
  }
  if (now.empty() && !known.empty()) {
    story_.events.add(time, Level::kInfo, "component", name + ": is well again");
  }
  known = now;
}

}  // namespace swiftlet
