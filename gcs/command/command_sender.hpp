// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/commander/mission_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// Of a take-off that nobody gave another: indoors, 4 ft in seed 004 [m].
inline constexpr double kUsualAltitude = 1.2;

/// What a person asks of the vehicle: a mode command, or where in the map or on Earth to fly.
struct GroundCommand {
  std::string name;          ///< as it was typed
  std::uint8_t command = 0;  ///< of ModeCommand, where it is no mission
  double altitude = 0.0;     ///< of TAKEOFF [m]
  std::uint32_t item = 0;    ///< of MISSION_START; 0: where it was paused, or the first
  std::string successor;     ///< of CONTROL_GIVE: a station
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

/// Sends one command at a time, again and again with the same identity, until the vehicle
/// acknowledges it or a time has passed. A vehicle carries out a command once, however often it
/// hears it. The owner brings what is heard and the time.
class CommandSender {
 public:
  struct Topics {
    Publisher<swiftlet_msgs::msg::ModeCommand> mode;
    Publisher<swiftlet_msgs::msg::Mission> waypoints;
    int domain = 0;       ///< for who looks for the vehicle
    std::string station;  ///< that commands
  };
  /// From the start of a program to its end it may take two seconds.
  static constexpr Duration kTimeout = std::chrono::milliseconds(1500);

  explicit CommandSender(Topics topics) : topics_(std::move(topics)) {}

  /// Begins to send at `first_send`, and gives up after `patience`. A command that is still under
  /// way is given up.
  void begin(const GroundCommand& command, Time now, Time first_send, Duration patience = kTimeout);
  void begin(const GroundCommand& command, Time now) { begin(command, now, now); }
  bool busy() const { return command_.has_value(); }
  /// What is under way; only where it is busy.
  const std::string& name() const { return command_->name; }
  /// Of the command that is under way, or was last: a mission has it on the vehicle, too.
  const std::string& id() const { return id_; }

  void hear(const swiftlet_msgs::msg::CommandAck& ack);
  void hear(const nav_msgs::msg::Odometry& odometry);
  /// Sends what is due, some ten times a second or more often. How the command ended, once.
  std::optional<CommandOutcome> advance(Time now);

 private:
  void send(Time now);
  void send(swiftlet_msgs::msg::Mission mission);
  std::string why_no_answer() const;

  Topics topics_;
  std::optional<GroundCommand> command_;
  std::string id_;
  std::uint64_t count_ = 0;
  Time deadline_{};
  Time next_send_{};
  std::optional<double> height_;  // of the vehicle [m]
  std::optional<CommandOutcome> outcome_;
};

}  // namespace swiftlet
