// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "components/sim/scenario.hpp"

namespace swiftlet {

/// The parts of a scenario file that describe the vehicle: each reads its mapping over the
/// defaults that are there, and throws ConfigError.
void read_vehicle(const Config& config, Quadrotor::Params& params);
void read_sensors(const Config& config, Scenario::Sensors& sensors);
void read_claw(const Config& config, ClawServo::Params& claw);

}  // namespace swiftlet
