// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/topics.hpp"

namespace swiftlet {

/// What is known of the vehicle right now.
struct VehicleView {
  std::optional<swiftlet_msgs::msg::VehicleStatus> status;
  std::optional<nav_msgs::msg::Odometry> odometry;
  std::optional<sensor_msgs::msg::BatteryState> battery;
};

/// Several lines for people, one line for a log, and JSON for scripts.
std::string describe(const VehicleView& view);
std::string one_line(const VehicleView& view);
std::string to_json(const VehicleView& view);

/// Listens to the vehicle. With `watch`, prints a line a second until it is interrupted; without,
/// ends the run when status and odometry were heard, or after two seconds.
class StatusClient : public Component {
 public:
  StatusClient(const ComponentContext& context, bool watch);
  const VehicleView& view() const { return view_; }

 private:
  void advance(Time now);

  bool watch_;
  Time begin_;
  Time status_heard_;
  VehicleView view_;
};

}  // namespace swiftlet
