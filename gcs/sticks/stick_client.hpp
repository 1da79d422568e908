// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/terminal/terminal.hpp"
#include "components/topics.hpp"
#include "control/steering.hpp"
#include "gcs/sticks/key_sticks.hpp"

namespace swiftlet {

/// A remote control: says where the sticks are, 20 times a second, from the keys of the terminal or
/// as it was told. At the end the sticks are let go.
class StickClient : public Component {
 public:
  struct Held {
    Sticks sticks;
    double duration_s = 1.0;
  };
  /// Sticks held for a while, or those of the keys, which begin with the switch as it is in `held`.
  StickClient(const ComponentContext& context, const std::string& station, const Held& held,
              bool by_keys, Terminal& terminal);
  ~StickClient() override;

 private:
  void advance(Time now);
  void send(const Sticks& sticks, Time now);
  void show(const Sticks& sticks);
  bool is_refused() const;
  void end_held();

  std::string station_;
  Held held_;
  bool by_keys_;
  Terminal& terminal_;
  KeySticks keys_;
  Time begin_;
  std::optional<Time> matched_;  // since when somebody hears it
  std::optional<swiftlet_msgs::msg::VehicleStatus> status_;
  Publisher<swiftlet_msgs::msg::ManualControl> manual_control_;
};

/// Shows the vehicle that the ground station is there, as long as it lives: so it keeps control.
class Heartbeat : public Component {
 public:
  /// Whether the vehicle misses it when it falls silent. It says that it leaves, at its end.
  enum class Absence { kIsMissed, kIsNot };
  Heartbeat(const ComponentContext& context, const std::string& station, Absence absence);
  ~Heartbeat() override;

 private:
  void send(bool stays);
  std::string station_;
  Absence absence_;
  Publisher<swiftlet_msgs::msg::ComponentStatus> heartbeat_;
};

}  // namespace swiftlet
