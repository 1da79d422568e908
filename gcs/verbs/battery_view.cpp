// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/battery_view.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "components/battery_message.hpp"

namespace swiftlet {
namespace {

std::string known(double value, int digits, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.{}f} {}", value, digits, unit) : "?";
}

std::string time_text(const std::optional<double>& seconds) {
  if (!seconds) return "?";
  if (*seconds < 120.0) return fmt::format("{:.0f} s", *seconds);
  return fmt::format("{:.0f} min", *seconds / 60.0);
}

nlohmann::ordered_json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

}  // namespace

std::string describe(const BatteryView& battery) {
  const BatteryReport& report = battery.report;
  return fmt::format("charge    {}\nvoltage   {}\ncurrent   {}\ntime left {}\n",
                     known(report.percentage * 100.0, 0, "%"), known(report.voltage, 1, "V"),
                     known(report.current, 1, "A"), time_text(battery.seconds_left));
}

std::string to_json(const BatteryView& battery) {
  const BatteryReport& report = battery.report;
  const nlohmann::ordered_json json = {
      {"percentage", number(report.percentage)},
      {"voltage_v", number(report.voltage)},
      {"current_a", number(report.current)},
      {"charge_ah", number(report.charge)},
      {"time_left_s", battery.seconds_left ? number(*battery.seconds_left) : nullptr}};
  return json.dump(2) + "\n";
}

BatteryClient::BatteryClient(const ComponentContext& context, Duration patience)
    : Component(context) {
  subscribe(topic::battery, [this](const sensor_msgs::msg::BatteryState& battery) {
    const BatteryReport report = from_msg(battery);
    clock_.add(report, now());
    view_ = BatteryView{report, clock_.seconds_left(now())};
    if (view_->seconds_left) stop(0);
  });
  call_at(now() + patience, [this](Time) { stop(view_ ? 0 : 1); });
}

}  // namespace swiftlet
