// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/battery_clock.hpp"

#include <cmath>

namespace swiftlet::screen {
namespace {

/// Less is the noise of a battery that nothing is drawn from [A].
constexpr double kLeastCurrent = 0.1;

}  // namespace

void BatteryClock::add(const BatteryReport& report, Time now) {
  if (!samples_.empty() && now - samples_.back().time < std::chrono::seconds(1)) return;
  // A fresh battery has no past.
  if (!samples_.empty() && report.percentage > samples_.back().report.percentage + 0.05) {
    samples_.clear();
  }
  samples_.push_back({now, report});
  while (now - samples_.front().time > kWindow) samples_.pop_front();
}

std::optional<double> BatteryClock::seconds_left() const {
  if (samples_.empty()) return std::nullopt;
  const BatteryReport& last = samples_.back().report;
  double current = 0.0;
  for (const Sample& sample : samples_) current += sample.report.current;
  current /= static_cast<double>(samples_.size());
  if (std::isfinite(last.charge) && last.charge > 0.0 && current > kLeastCurrent) {
    return last.charge * 3600.0 / current;
  }
  const double used = samples_.front().report.percentage - last.percentage;
  const Duration passed = samples_.back().time - samples_.front().time;
  if (!(used >= kLeastUsed) || passed < kShortest) return std::nullopt;
  return last.percentage / used * to_seconds(passed);
}

}  // namespace swiftlet::screen
