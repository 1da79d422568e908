// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/sim/scenario.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// How a scripted flight ended.
struct FlightOutcome {
  bool finished = false;  ///< the run ended because of the flight, not of a signal
  bool success = false;
  std::string reason;      ///< "mission flown and landed", or what went wrong
  double flight_time = 0;  ///< from arming to disarming, or to the failure [s]
};

/// Flies the mission of a scenario with the commands that a person would give at the ground
/// station: arm, take off, the waypoints or the exploration, land. Then it ends the run, with exit
/// code 0 when all of it was done and 1 when not; the latter some seconds after the failure, to
/// show what became of the vehicle.
class Pilot : public Component {
 public:
  explicit Pilot(const ComponentContext& context);
  Pilot(const ComponentContext& context, const Scenario& scenario);

  const FlightOutcome& outcome() const { return outcome_; }

 private:
  enum class Step { kArm, kTakeoff, kMission, kLand, kDone };

  void advance(Time now);
  void send(Time now);
  void begin(Step step);
  void finish(bool success, const std::string& reason);
  void end();
  void on_ack(const swiftlet_msgs::msg::CommandAck& ack);
  std::string command_id() const;
  const char* step_name() const;

  Scenario scenario_;
  Step step_ = Step::kArm;
  bool acknowledged_ = false;
  Time begun_{};
  Time sent_{};
  Time armed_at_{};
  bool started_ = false;
  std::optional<Time> landed_at_;
  std::optional<Time> failed_at_;
  swiftlet_msgs::msg::VehicleStatus status_;
  std::optional<Time> status_heard_;
  FlightOutcome outcome_;
  Publisher<swiftlet_msgs::msg::ModeCommand> mode_;
  Publisher<swiftlet_msgs::msg::Mission> waypoints_;
};

}  // namespace swiftlet
