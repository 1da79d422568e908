// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/commander/mission_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// What a person asks of the vehicle: a mode command, or a place in the map or on Earth to fly to.
struct GroundCommand {
  std::string name;          ///< as it was typed
  std::uint8_t command = 0;  ///< of ModeCommand, where it is no `go_to`
  double altitude = 0.0;     ///< of TAKEOFF [m]
  struct Place {
    double x = 0.0;           ///< [m]
    double y = 0.0;           ///< [m]
    std::optional<double> z;  ///< [m]; without, the height that the vehicle has
  };
  std::optional<Place> go_to;
  std::optional<GlobalWaypoint> go_to_global;
  bool is_mission() const { return go_to || go_to_global; }
};

/// How it ended, in a sentence.
struct CommandOutcome {
  bool accepted = false;
  std::string text;
};

/// Sends one command, again and again with the same identity, until the vehicle acknowledges it or
/// two seconds have passed; then it ends the run. A vehicle carries out a command once, however
/// often it hears it.
class CommandClient : public Component {
 public:
  CommandClient(const ComponentContext& context, const GroundCommand& command);

  const CommandOutcome& outcome() const { return outcome_; }

 private:
  void advance(Time now);
  void send(Time now);
  void finish(bool accepted, const std::string& text);

  GroundCommand command_;
  std::string id_;
  Time begin_;
  Time next_send_;
  std::optional<double> height_;  // of the vehicle, from odometry
  std::string vehicle_reason_;
  CommandOutcome outcome_;
  Publisher<swiftlet_msgs::msg::ModeCommand> mode_;
  Publisher<swiftlet_msgs::msg::Mission> waypoints_;
};

}  // namespace swiftlet
