// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/flight_director.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What a standby needs of the director's state; header, mission id and answers are the
/// commander's.
swiftlet_msgs::msg::CommanderState to_msg(const FlightDirector::State& state);
FlightDirector::State from_msg(const swiftlet_msgs::msg::CommanderState& message);

/// Whether the standby must be told: something was decided in between.
bool differs(const FlightDirector::State& a, const FlightDirector::State& b);

/// What ground stations are told; header, mission id and station are the commander's.
swiftlet_msgs::msg::VehicleStatus to_msg(const FlightDirector::Status& status);

}  // namespace swiftlet
