// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/topics.hpp"
#include "gcs/command_sender.hpp"
#include "gcs/screen/screen_painter.hpp"
#include "gcs/screen/shell/curses_terminal.hpp"
#include "gcs/screen/shell/error_lines.hpp"
#include "gcs/screen/shell/parameter_asker.hpp"
#include "gcs/screen/shell/vehicle_listener.hpp"
#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {

/// The ground station's screen: what is heard goes into the model, keys into the controller, what
/// it asks for to the vehicle, and ten times a second a picture to the terminal.
class ScreenComponent : public VehicleListener {
 public:
  /// Terminal and error lines are used only while the run lasts.
  ScreenComponent(const ComponentContext& context, CursesTerminal& terminal, ErrorLines& errors);

 private:
  void listen();
  void advance(Time now);
  void steer(Time now);
  void carry_out(const Action& action, Time now);
  void send(const Action& action, Time now);
  void ask(const Action& action, Time now);
  void hear(const swiftlet_msgs::msg::ParameterReply& reply);
  void tell(Severity severity, const std::string& text);
  Circumstances circumstances(Time now) const;

  CursesTerminal& terminal_;
  ErrorLines& errors_;
  Controller controller_;
  MapPicture picture_;
  CommandSender sender_;
  ParameterAsker asker_;
  Publisher<swiftlet_msgs::msg::ManualControl> manual_control_;
  bool steered_ = false;
  int ticks_ = 0;
};

}  // namespace swiftlet::screen
