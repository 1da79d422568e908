// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "components/sim/contact.hpp"
#include "components/sim/world.hpp"
#include "control/quadrotor_model.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// What a simulated sensor may know of the vehicle that carries it.
struct VehicleTruth {
  Time time{};
  RigidBodyState body;
  /// Acceleration less gravity of the centre of mass, mean of the last step, in B [m/s^2].
  Eigen::Vector3d specific_force{0.0, 0.0, kGravity};
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< in B [rad/s^2]
  Eigen::Vector4d rotor_thrusts = Eigen::Vector4d::Zero();         ///< [N]
  bool on_ground = false;                                          ///< touches ground
};

/// A quadrotor as a rigid body: equations 1 and 2 of seed 000, from its NED-like axes to ENU/FLU
/// (thrust along +z of the body, gravity along -z of the world). Added to them: a first-order lag
/// of the rotors, limits of their thrust, drag against the air, contact with ground and obstacles.
///
/// Fourth-order Runge-Kutta in steps of at most 1 ms; forces of contact and rotors are constant
/// during a step. Whatever the commands are, the state stays finite.
class Quadrotor {
 public:
  struct Params {
    QuadrotorModel model;
    double linear_drag = 0.10;     ///< against the air [N s/m]
    double quadratic_drag = 0.02;  ///< against the air [N s^2/m^2]
    GroundContact::Params ground;
    HullContact::Params hull;
  };

  explicit Quadrotor(const Params& params);

  /// Puts the vehicle somewhere, with its rotors stopped. A state that is not finite is refused:
  /// nothing changes and the result is false.
  bool reset(Time time, const RigidBodyState& body);

  /// Moves on by `dt` (steps above 1 ms are divided; nothing happens for dt <= 0).
  /// `thrust_commands` [N] per rotor: a command above zero is kept within the limits of the model,
  /// zero and less (or not a number) switches the rotor off. `wind` is the velocity of the air in
  /// the world [m/s], `push` a force on the centre of mass, in the world [N].
  void step(Duration dt, const Eigen::Vector4d& thrust_commands, const Eigen::Vector3d& wind,
            const World& world, const Eigen::Vector3d& push = Eigen::Vector3d::Zero());

  const VehicleTruth& truth() const { return truth_; }
  const HullContact& hull() const { return hull_; }
  const Params& params() const { return params_; }

 private:
  void substep(double dt, const Eigen::Vector4d& commands, const Eigen::Vector3d& wind,
               const World& world, const Eigen::Vector3d& push);
  Eigen::Vector4d lag_rotors(double dt, const Eigen::Vector4d& commands);

  Params params_;
  Eigen::Matrix4d allocation_;
  GroundContact ground_;
  HullContact hull_;
  VehicleTruth truth_;
};

}  // namespace swiftlet
