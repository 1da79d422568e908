// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace swiftlet {

/// What controller and simulator know of the vehicle.
///
/// Rotors 1 to 4 sit on a plus: front (+x), right (-y), back (-x), left (+y), each `arm_length`
/// from the centre of mass. Rotors 1 and 3 turn clockwise seen from above. Defaults are the 0.9 kg
/// platform of seed 000.
struct QuadrotorModel {
  double mass = 0.9;                                 ///< [kg]
  Eigen::Vector3d inertia{6.5e-3, 6.5e-3, 1.15e-2};  ///< principal moments, FLU [kg m^2]
  double arm_length = 0.17;                          ///< d of equation 2 [m]
  double torque_per_thrust = 0.016;                  ///< c of equation 2 [m]
  double rotor_thrust_min = 0.05;                    ///< what a turning rotor cannot go below [N]
  double rotor_thrust_max = 5.0;                     ///< of one rotor [N]
  double rotor_time_constant = 0.03;                 ///< first-order lag of the thrust [s]
};

/// Collective thrust [N] and body moment [N m], in FLU.
struct Wrench {
  double thrust = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// [thrust, Mx, My, Mz] = allocation_matrix(model) * rotor thrusts.
///
/// Equation 2 of seed 000, from its forward-right-down axes to FLU: the rows of My and Mz change
/// sign, that of Mx does not.
inline Eigen::Matrix4d allocation_matrix(const QuadrotorModel& model) {
  const double d = model.arm_length;
  const double c = model.torque_per_thrust;
  Eigen::Matrix4d A;
  A << 1, 1, 1, 1,  //
      0, -d, 0, d,  //
      -d, 0, d, 0,  //
      c, -c, c, -c;
  return A;
}

}  // namespace swiftlet
