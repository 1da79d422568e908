// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimation/geometry/pose2.hpp"

namespace swiftlet {

/// What a vehicle without odometry is taken to do: go on as it did. A Kalman filter of its velocity
/// in its own axes (vx, vy, yaw rate), which scans correct as far as they tell. So it goes on in a
/// corridor, too, where no scan says how far it has come.
class MotionModel {
 public:
  struct Params {
    double max_speed = 0.9;         ///< [m/s]
    double max_yaw_rate = 1.2;      ///< [rad/s]
    double acceleration = 0.5;      ///< by which the velocity changes in a second: sigma [m/s]
    double yaw_acceleration = 0.7;  ///< the same [rad/s]
    double max_time = 0.6;          ///< that long a motion is thought to go on [s]
  };
  explicit MotionModel(const Params& params) : params_(params) { forget(); }

  struct Motion {
    Pose2 relative;              ///< T_now_then
    Eigen::Matrix3d covariance;  ///< of (x, y, yaw) [m, rad], in the axes of now
  };
  /// What the vehicle will do in so many seconds; nothing where that is too long, or so short that
  /// the stamps must be wrong.
  std::optional<Motion> predict(double seconds) const;
  /// What it did in the last `seconds`, with what is known of that: the inverse covariance of
  /// (x, y, yaw) in the axes of the beginning. What no such vehicle does ends all that was known.
  void update(double seconds, const Pose2& relative, const Eigen::Matrix3d& information);

 private:
  void forget();
  Eigen::Matrix3d covariance_after(double seconds) const;

  Params params_;
  Eigen::Vector3d velocity_;  ///< [m/s, rad/s]
  Eigen::Matrix3d covariance_;
};

}  // namespace swiftlet
