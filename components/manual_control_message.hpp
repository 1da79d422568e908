// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/conversions.hpp"
#include "control/steering.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Sticks as ManualControl has them, of a ground station; "" for the vehicle's own remote control.
inline swiftlet_msgs::msg::ManualControl to_msg(const Sticks& sticks, Time time,
                                                const std::string& station) {
  swiftlet_msgs::msg::ManualControl message;
  message.header(make_header(time, "base_link"));
  message.forward(static_cast<float>(sticks.forward));
  message.left(static_cast<float>(sticks.left));
  message.up(static_cast<float>(sticks.up));
  message.turn(static_cast<float>(sticks.turn));
  message.assisted(sticks.assisted);
  message.station(station);
  return message;
}
inline Sticks from_msg(const swiftlet_msgs::msg::ManualControl& message) {
  return {message.forward(), message.left(), message.up(), message.turn(), message.assisted()};
}

}  // namespace swiftlet
