// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/topics.hpp"
#include "estimation/battery/battery_clock.hpp"

namespace swiftlet {

/// What is known of a battery. What it does not measure is NaN.
struct BatteryView {
  BatteryReport report;
  std::optional<double> seconds_left;
};

/// Lines for people, with `?` for what is not known, and JSON for scripts, with null for it.
std::string describe(const BatteryView& battery);
std::string to_json(const BatteryView& battery);

/// Listens until all is known, or for `patience`; ends the run with 0 where a battery was heard,
/// else 1.
class BatteryClient : public Component {
 public:
  BatteryClient(const ComponentContext& context, Duration patience);
  const std::optional<BatteryView>& view() const { return view_; }

 private:
  BatteryClock clock_;
  std::optional<BatteryView> view_;
};

}  // namespace swiftlet
