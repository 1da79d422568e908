// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"
#include "components/mode_message.hpp"
#include "components/runtime/host.hpp"
#include "components/sim/scenario.hpp"
#include "components/topics.hpp"
#include "control/steering.hpp"

namespace swiftlet::test {

/// A pilot with a remote control and a ground station, who does one thing after the other.
class ScriptedPilot : public Component {
 public:
  using Component::advertise, Component::every, Component::now, Component::subscribe;

  /// One thing: what he does at its beginning, where his sticks are, and until when.
  struct Step {
    std::string name;
    std::function<void()> begin = [] {};
    std::function<bool()> done = [] { return true; };
    double limit_s = 60.0;
    Sticks sticks;
  };

  explicit ScriptedPilot(const ComponentContext& context);

  std::vector<Step> script;

  // What he sees.
  swiftlet_msgs::msg::VehicleStatus status;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();  // where the vehicle is [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  bool on_ground = true;
  unsigned contacts = 0;
  std::string last_contact;
  double clearance = 1e9;  // smallest so far
  bool guard_acting = false;
  std::string guard_reason;
  /// "Hover: 1.20 m reached", each time that mode or reason changed.
  std::vector<std::string> log;
  std::string failure;  // the step that was not done in time
  double step_s = 0.0;  // since the step began

  std::string mode() const { return mode_name(status.mode()); }
  bool is_in(const char* mode_name) const { return mode() == mode_name; }

  // What he can do.
  void command(std::uint8_t what, double altitude = 0.0);
  void go_to(const Eigen::Vector3d& place);
  void go_to_global(const GlobalWaypoint& place);
  void send_map(const nav_msgs::msg::OccupancyGrid& map) { map_.publish(map); }
  bool remote = true;  // it is on

 private:
  void advance(Time now);

  std::size_t step_ = 0;
  std::optional<Time> step_begun_;
  int commands_ = 0;
  Publisher<swiftlet_msgs::msg::ModeCommand> mode_;
  Publisher<swiftlet_msgs::msg::Mission> waypoints_;
  Publisher<swiftlet_msgs::msg::ManualControl> sticks_;
  Publisher<nav_msgs::msg::OccupancyGrid> map_;
};

/// The whole stack in lockstep, in a courtyard that has room for every mode.
class ModeFlight {
 public:
  /// `parameters`: YAML of all components.
  explicit ModeFlight(const std::string& parameters = "", std::vector<Fault> faults = {});

  ScriptedPilot& pilot() { return *pilot_; }
  /// A component falls silent, as if its process had been killed.
  void kill(const std::string& component) { components_.at(component)->halt(); }

  /// Steps that bring it to a mode, by commands alone, and to where something can go wrong.
  void take_off(double altitude = 1.2);
  void add(ScriptedPilot::Step step) { pilot_->script.push_back(std::move(step)); }
  /// Looks at something, at that moment.
  void check(std::function<void()> look) {
    add({"look", std::move(look), [] { return true; }, 5.0, {}});
  }
  /// Sends a command, and waits for the mode that follows.
  void order(std::uint8_t what, const char* mode, double altitude = 0.0);
  void wait(double seconds);
  void hold(const Sticks& sticks, double seconds);
  void until(const char* mode, double limit_s = 60.0);
  void land();

  /// Flies the script. Fails where a step is not done in time, and where anything is touched.
  void fly();

 private:
  Host host_;
  std::map<std::string, Component*> components_;
  ScriptedPilot* pilot_ = nullptr;
};

}  // namespace swiftlet::test
