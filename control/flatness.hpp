// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// Attitude that points the body's z axis along a force and its x axis to a heading, and how it
/// moves.
struct FlatAttitude {
  Eigen::Matrix3d R_WC = Eigen::Matrix3d::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< in C [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< in C [rad/s^2]
};

/// Differential flatness of the multirotor (seed 000, reference [24], and the derivatives of
/// equation 3 in closed form).
///
/// `force` [m/s^2] is thrust per mass in the world; it must not be zero nor point along the
/// heading `yaw`. `force_rate` and `force_acceleration` are its derivatives, jerk and snap where
/// the reference is tracked without error.
FlatAttitude flat_attitude(const Eigen::Vector3d& force, const Eigen::Vector3d& force_rate,
                           const Eigen::Vector3d& force_acceleration, double yaw, double yaw_rate,
                           double yaw_acceleration);

/// State of a vehicle that tracks `reference` without error. The reference must not be in free
/// fall.
RigidBodyState flat_state(const FlatReference& reference);

}  // namespace swiftlet
