// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/terminal/terminal.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// What is known of the vehicle right now.
struct VehicleView {
  std::optional<swiftlet_msgs::msg::VehicleStatus> status;
  std::optional<swiftlet_msgs::msg::MissionState> mission;  // that was uploaded
  std::optional<nav_msgs::msg::Odometry> odometry;
  std::optional<sensor_msgs::msg::BatteryState> battery;
  std::optional<swiftlet_msgs::msg::ClawState> claw;  // where there is one
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
  /// With a terminal, until the vehicle may be armed, and the terminal says meanwhile why not.
  StatusClient(const ComponentContext& context, Duration patience, Terminal* until_ready);
  /// What `each_second` makes of the view is printed, a line a second until it is interrupted.
  using Line = std::string (*)(const VehicleView& view);
  StatusClient(const ComponentContext& context, Line each_second);
  const VehicleView& view() const { return view_; }

 private:
  void advance(Time now);

  StatusClient(const ComponentContext& context, Duration patience, Terminal* until_ready,
               Line each_second);
  bool waits() const;

  Terminal* until_ready_;
  Line each_second_;
  Time deadline_;
  bool has_what_it_waits_for_ = false;
  Time status_heard_;
  VehicleView view_;
};

}  // namespace swiftlet
