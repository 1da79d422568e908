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
  std::optional<swiftlet_msgs::msg::MissionState> mission;  // that was uploaded
  std::optional<nav_msgs::msg::Odometry> odometry;
  std::optional<sensor_msgs::msg::BatteryState> battery;
};

/// Several lines for people, one line for a log, and JSON for scripts, both ways.
std::string describe(const VehicleView& view);
std::string one_line(const VehicleView& view);
std::string to_json(const VehicleView& view);
std::string to_json_line(const VehicleView& view);

/// Listens to the vehicle until its status was heard, at most for `patience`, and then for a moment
/// for the rest; then it ends the run.
class StatusClient : public Component {
 public:
  static constexpr Duration kPatience = std::chrono::milliseconds(1500);
  explicit StatusClient(const ComponentContext& context, Duration patience = kPatience);
  /// What `each_second` makes of the view is printed, a line a second until it is interrupted.
  using Line = std::string (*)(const VehicleView& view);
  StatusClient(const ComponentContext& context, Line each_second);
  const VehicleView& view() const { return view_; }

 private:
  void advance(Time now);

  StatusClient(const ComponentContext& context, Duration patience, Line each_second);

  Line each_second_;
  Time deadline_;
  Time status_heard_;
  VehicleView view_;
};

}  // namespace swiftlet
