// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config.hpp"
#include "control/quadrotor_model.hpp"

namespace swiftlet {

/// Reads what a file says of the vehicle over what `model` holds.
inline void read_model(const Config& config, QuadrotorModel& model) {
  config.read("mass", model.mass, kPositive);
  config.read("inertia", model.inertia, kPositive);
  config.read("arm_length", model.arm_length, kPositive);
  config.read("torque_per_thrust", model.torque_per_thrust, kPositive);
  config.read("rotor_thrust_min", model.rotor_thrust_min, kNotNegative);
  config.read("rotor_thrust_max", model.rotor_thrust_max, kPositive);
  config.read("rotor_time_constant", model.rotor_time_constant, kPositive);
}

}  // namespace swiftlet
