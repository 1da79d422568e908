// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace swiftlet {

/// Standard gravity [m/s^2]. The world is ENU: gravity acts along -z.
inline constexpr double kGravity = 9.80665;

/// Where a rigid body is and how it moves. World W is ENU, body B is FLU (REP-103, REP-105).
struct RigidBodyState {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();            ///< position [m]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  ///< attitude, body to world
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();          ///< velocity in the world [m/s]
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< angular velocity in the body [rad/s]
};

/// What a multirotor is asked to do at one moment: its flat outputs (position and yaw) and their
/// derivatives, in the world frame.
struct FlatReference {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d jerk = Eigen::Vector3d::Zero();          ///< [m/s^3]
  Eigen::Vector3d snap = Eigen::Vector3d::Zero();          ///< [m/s^4]
  double yaw = 0.0;                                        ///< [rad]
  double yaw_rate = 0.0;                                   ///< [rad/s]
  double yaw_acceleration = 0.0;                           ///< [rad/s^2]
};

/// One sample of an inertial measurement unit, in the body frame.
struct ImuSample {
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2], +g on z at rest
};

}  // namespace swiftlet
