// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "control/quadrotor_model.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// Reads what a file says of the vehicle over what `model` holds, the same for the controller and
/// for the simulator. Throws ConfigError where such a vehicle could not fly.
inline void read_vehicle_model(const Config& config, QuadrotorModel& model) {
  config.read("mass", model.mass, kPositive);
  config.read("inertia", model.inertia, kPositive);
  config.read("arm_length", model.arm_length, kPositive);
  config.read("torque_per_thrust", model.torque_per_thrust, kPositive);
  config.read("rotor_thrust_min", model.rotor_thrust_min, kNotNegative);
  config.read("rotor_thrust_max", model.rotor_thrust_max, kPositive);
  if (model.rotor_thrust_max <= model.rotor_thrust_min) {
    config.fail("rotor_thrust_max", "'rotor_thrust_max' must be more than 'rotor_thrust_min'");
  }
  if (4.0 * model.rotor_thrust_max <= model.mass * kGravity) {
    config.fail("rotor_thrust_max",
                "four times 'rotor_thrust_max' does not lift 'mass'; raise it or lower the mass");
  }
  config.read("rotor_time_constant", model.rotor_time_constant, kNotNegative);
}

}  // namespace swiftlet
