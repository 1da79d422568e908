// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "components/report/motion_reader.hpp"

namespace swiftlet {

/// Reads what was decided: modes, commands and their answers, missions, the guard, the planner.
class DecisionReader {
 public:
  explicit DecisionReader(FlightStory& story) : story_(story) {}

  /// That modes will come: before the first of them, nobody flies.
  void expect_modes() { phase_.is_known = true; }
  /// `position`: where the vehicle was last.
  void on_status(double time, const swiftlet_msgs::msg::VehicleStatus& message,
                 const std::optional<Eigen::Vector3d>& position);
  void on_command(double time, const swiftlet_msgs::msg::ModeCommand& message);
  void on_ack(double time, const swiftlet_msgs::msg::CommandAck& message);
  void on_mission(double time, const swiftlet_msgs::msg::Mission& message);
  void on_uploaded(double time, const swiftlet_msgs::msg::MissionState& message);
  void on_goal(double time, const geometry_msgs::msg::PoseStamped& message);
  void on_guard(double time, const swiftlet_msgs::msg::GuardStatus& message,
                const std::optional<Eigen::Vector3d>& position);
  void on_trajectory(double time, const swiftlet_msgs::msg::Trajectory& message);
  void on_exploration(double time, const swiftlet_msgs::msg::Exploration& message);
  /// Writes down the flight time and the outcome.
  void finish();

  const FlightPhase& phase() const { return phase_; }

 private:
  using Level = FlightEvent::Level;
  void note_mode(double time, const swiftlet_msgs::msg::VehicleStatus& message,
                 const std::optional<Eigen::Vector3d>& position);
  void note_mission(double time, const swiftlet_msgs::msg::VehicleStatus& message);
  std::string landed() const;

  FlightStory& story_;
  FlightPhase phase_;
  std::optional<swiftlet_msgs::msg::VehicleStatus> status_;
  std::map<std::string, std::string> asked_;  // what a command asked for, by its id
  std::set<std::string> answered_;
  std::set<std::string> missions_;
  std::optional<swiftlet_msgs::msg::MissionState> uploaded_;
  bool guard_acts_ = false;
  std::string planner_failure_;
  std::optional<std::uint8_t> exploration_;
};

}  // namespace swiftlet
