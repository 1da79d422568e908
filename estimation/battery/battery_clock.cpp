// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/battery/battery_clock.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

/// Less is the noise of a battery that nothing is drawn from [A].
constexpr double kLeastCurrent = 0.1;

}  // namespace

void BatteryClock::add(const BatteryReport& report, Time now) {
  if (!samples_.empty() && now - samples_.back().time < std::chrono::seconds(1)) return;
  samples_.push_back({now, report});
  while (now - samples_.front().time > kWindow) samples_.pop_front();
  slope_.add(now, report.percentage);
}

std::optional<double> BatteryClock::seconds_left(Time now) const {
  if (samples_.empty()) return std::nullopt;
  const Sample& last = samples_.back();
  const double age = to_seconds(now - last.time);
  if (age > DischargeEstimate::Params().longest_gap) return std::nullopt;
  double current = 0.0;
  for (const Sample& sample : samples_) current += sample.report.current;
  current /= static_cast<double>(samples_.size());
  const double charge = last.report.charge;
  if (std::isfinite(charge) && charge > 0.0 && current > kLeastCurrent) {
    return std::max(charge * 3600.0 / current - age, 0.0);
  }
  return slope_.time_left(now);
}

}  // namespace swiftlet
