// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "control/quadrotor_model.hpp"

namespace swiftlet {

/// Rotor thrusts for a wrench, and what had to be given up for them.
struct MixerOutput {
  Eigen::Vector4d rotor_thrusts = Eigen::Vector4d::Zero();  ///< rotors 1 to 4 [N]
  Wrench achieved;                                          ///< what these thrusts add up to
  bool roll_pitch_limited = false;  ///< moment about x or y smaller than asked for
  bool thrust_limited = false;      ///< collective thrust other than asked for
  bool yaw_limited = false;         ///< moment about z smaller than asked for
  bool input_refused = false;       ///< the wrench was not finite; hover thrust stood in for it
};

/// Inverse of equation 2 of seed 000 within the limits of the rotors.
///
/// Rotors 1 and 3 make the pitch moment and their sum A, rotors 2 and 4 the roll moment and their
/// sum B; thrust is A + B and the yaw moment c (A - B). What cannot be had is given up in this
/// order:
///   1. yaw, down to zero but never past it: the vehicle may turn slower, not the wrong way;
///   2. collective thrust, by as little as possible;
///   3. roll and pitch, each only where no thrust at all allows it, |M| > d (f_max - f_min).
/// Every thrust is within [rotor_thrust_min, rotor_thrust_max], whatever is asked for.
class Mixer {
 public:
  /// Throws std::invalid_argument where the model has no room between its limits.
  explicit Mixer(const QuadrotorModel& model);

  MixerOutput mix(const Wrench& wrench) const;

  /// Rotors that stand still: the only command below `rotor_thrust_min`.
  static Eigen::Vector4d motors_off() { return Eigen::Vector4d::Zero(); }

 private:
  QuadrotorModel model_;
};

}  // namespace swiftlet
