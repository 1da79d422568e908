// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/topics.hpp"
#include "gcs/command/command_sender.hpp"
#include "gcs/screen/screen_painter.hpp"
#include "gcs/screen/shell/curses_terminal.hpp"
#include "gcs/screen/shell/error_lines.hpp"
#include "gcs/screen/shell/mission_errand.hpp"
#include "gcs/screen/shell/parameter_asker.hpp"
#include "gcs/screen/shell/vehicle_listener.hpp"
#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {

/// The ground station's screen: what is heard goes into the model, keys into the controller, what
/// it asks for to the vehicle, and ten times a second a picture to the terminal.
class ScreenComponent : public VehicleListener {
 public:
  /// Terminal and error lines are used only while the run lasts.
  ScreenComponent(const ComponentContext& context, const std::string& station,
                  CursesTerminal& terminal, ErrorLines& errors);

 private:
  void listen();
  void heard(const swiftlet_msgs::msg::MissionState& state) override;
  void advance(Time now);
  void steer(Time now);
  void tell(Severity severity, const std::string& text);

  // screen_actions.cpp
  void carry_out(const Action& action, Time now);
  void send(const Action& action, Time now);
  void begin(const Action& action, Time now);
  void ask(const Action& action, Time now);
  void hear(const swiftlet_msgs::msg::ParameterReply& reply);
  void take(const CommandOutcome& outcome, Time now);

  // screen_missions.cpp
  void bring(const Action& action, Time now);
  void fetch(Time now);
  void carry_mission(Time now);
  void put_into_list(MissionFile mission);
  void save(const Action& action);
  void load(const Action& action);
  std::size_t note(const std::string& file, const std::vector<MissionRemark>& remarks);

  std::string station_;
  CursesTerminal& terminal_;
  ErrorLines& errors_;
  Controller controller_;
  MapPicture picture_;
  CommandSender sender_;
  ParameterAsker asker_;
  MissionErrand errand_;
  std::uint64_t fetched_over_ = 0;  // revision of the list when its successor was asked for
  bool pauses_ = false;             // a mission, by the command that is under way
  Publisher<swiftlet_msgs::msg::ManualControl> manual_control_;
  Publisher<swiftlet_msgs::msg::MissionPart> mission_parts_;
  Publisher<swiftlet_msgs::msg::MissionFetch> mission_fetch_;
  bool steered_ = false;
  int ticks_ = 0;
};

}  // namespace swiftlet::screen
