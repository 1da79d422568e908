// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/quadrotor_model.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// Integral of the position error [m s], held by the caller. See Se3Controller::integrate.
struct PositionIntegral {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// The commanded wrench, and the errors that led to it (equations 5 and 6), for diagnostics.
struct TrackingOutput {
  Wrench wrench;
  Eigen::Vector3d position_error = Eigen::Vector3d::Zero();  ///< e_x, world [m]
  Eigen::Vector3d velocity_error = Eigen::Vector3d::Zero();  ///< e_v, world [m/s]
  Eigen::Vector3d attitude_error = Eigen::Vector3d::Zero();  ///< e_R, body [1]
  Eigen::Vector3d rate_error = Eigen::Vector3d::Zero();      ///< e_Omega, body [rad/s]
  Eigen::Quaterniond q_WC = Eigen::Quaterniond::Identity();  ///< commanded attitude
  Eigen::Vector3d commanded_rate = Eigen::Vector3d::Zero();  ///< Omega_c, commanded frame [rad/s]
  bool force_limited = false;  ///< tilt or thrust limits changed the desired force
  bool input_refused = false;  ///< state or reference was unusable; the wrench is a safe one
};

/// Error of attitude R_WB against the commanded R_WC (equation 5): half the vee of
/// R_WC^T R_WB - R_WB^T R_WC, sin(angle) times the axis.
Eigen::Vector3d attitude_error(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& R_WC);

/// Nonlinear tracking controller on SE(3): equations 3 to 6 of seed 000.
///
/// The paper's axes are forward-right-down; here the world is ENU and the body FLU, so thrust
/// pushes along +z of the body and gravity is compensated with +g. Commanded attitude, angular
/// velocity and angular acceleration come from force, jerk, snap and yaw (flatness.hpp). Errors
/// of attitude below 90 degrees decay exponentially; from beyond, almost always.
///
/// Additions to the paper: integral action on position against steady wind; limits on tilt,
/// thrust, heading error and commanded rates, and rates that are followed less the further the
/// attitude is from its command, so that no reference turns the vehicle over and none is singular.
/// No input, however broken, gives a value that is not finite.
class Se3Controller {
 public:
  /// Gains are per mass and per inertia: the paper's k_x is `position_gain` times the mass, its
  /// k_R is `attitude_gain` times the inertia. Vectors are by axis: world for position and
  /// velocity, body for attitude and rate.
  struct Params {
    Eigen::Vector3d position_gain{8.0, 8.0, 8.0};       ///< [1/s^2]
    Eigen::Vector3d velocity_gain{4.5, 4.5, 4.5};       ///< [1/s]
    Eigen::Vector3d attitude_gain{120.0, 120.0, 25.0};  ///< [1/s^2]
    Eigen::Vector3d rate_gain{18.0, 18.0, 8.0};         ///< [1/s]
    Eigen::Vector3d integral_gain{2.0, 2.0, 2.0};       ///< on position, not in the paper [1/s^3]
    double max_integral_acceleration = 2.0;  ///< what the integral may ask for, each axis [m/s^2]
    /// The integral waits while the velocity is further off than this: wind holds the vehicle
    /// beside its reference, a push moves it [m/s].
    double max_integral_velocity_error = 0.3;

    double max_tilt = 0.61;                            ///< of the commanded force, below 1.4 [rad]
    double min_specific_thrust = 2.0;                  ///< per mass [m/s^2]
    double max_specific_thrust = 19.0;                 ///< per mass [m/s^2]
    double max_commanded_rate = 8.0;                   ///< of Omega_c [rad/s]
    double max_commanded_angular_acceleration = 80.0;  ///< of Omega_c's derivative [rad/s^2]
    double max_heading_error = 0.8;      ///< of the commanded heading to the vehicle's [rad]
    double max_yaw_rate = 3.0;           ///< feed-forward [rad/s]
    double max_yaw_acceleration = 10.0;  ///< feed-forward [rad/s^2]
  };

  /// Throws std::invalid_argument where parameters or model cannot be flown with.
  Se3Controller(const Params& params, const QuadrotorModel& model);

  /// One step of the control law.
  TrackingOutput compute(const RigidBodyState& state, const FlatReference& reference,
                         const PositionIntegral& integral = {}) const;

  /// The integral after `dt` seconds with the errors of `output`. It stops where the force is
  /// limited and where the vehicle moves against its reference, and never asks for more than
  /// `max_integral_acceleration` (anti-windup).
  PositionIntegral integrate(const PositionIntegral& integral, const TrackingOutput& output,
                             double dt) const;

  /// Levels the vehicle without position or velocity, for setpoints that went stale and estimates
  /// that were lost: attitude to level, rates to zero, heading left alone. The vertical force is
  /// `thrust_to_weight` times the weight (1 hovers, 0.9 sinks).
  Wrench level(const RigidBodyState& state, double thrust_to_weight = 1.0) const;

  const Params& params() const { return params_; }
  const QuadrotorModel& model() const { return model_; }

 private:
  struct Heading {
    double yaw, rate, acceleration;
  };
  Heading limited_heading(const Eigen::Quaterniond& q_WB, const FlatReference& reference) const;
  Eigen::Vector3d limited_force(const Eigen::Vector3d& desired, bool& limited) const;
  double limited_thrust(double specific_thrust) const;

  Params params_;
  QuadrotorModel model_;
};

}  // namespace swiftlet
