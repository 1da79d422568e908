// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// The vehicle's state from one odometry to the next, and for some seconds without any: carried on
/// with gyroscope w and accelerometer f,
///
///     q' = q * exp(w dt),    v' = v + (R f + g) dt,    p' = p + (v + v') / 2 dt,
///
/// with the mean of two samples for w and f, and R of the middle of the step: exact for constant
/// samples without turning, of second order otherwise.
///
/// While odometry comes, an observer runs beside it: attitude and velocity carried on likewise, and
/// drawn to those of odometry by second-order filters, whose integrators are the errors of the two
/// sensors. It is slower than an estimator that must follow every pose, and so the better place to
/// start from when no pose comes any more (let_go): a tilt that is wrong by 3 mrad is 0.13 m after
/// 3 s. The errors are those of sensor and estimate together: a tilt that the estimate always has
/// wrong is in the accelerometer's, where it does no harm.
///
/// What is not finite or not believable is ignored: the last good sample stands in for it, for at
/// most `max_gap`. Nothing makes the state anything but finite.
class InertialCarry {
 public:
  struct Params {
    double attitude_time_constant = 4.0;   ///< of the observer [s]
    double velocity_time_constant = 1.0;   ///< of the observer [s]
    double max_accelerometer_error = 1.0;  ///< that is believed, length [m/s^2]
    double max_gyroscope_error = 0.02;     ///< that is believed, length [rad/s]
    double max_gap = 0.05;                 ///< without samples, then motion is not known [s]
  };

  /// Throws std::invalid_argument where a parameter cannot be used.
  explicit InertialCarry(const Params& params);
  InertialCarry() : InertialCarry(Params{}) {}
  /// Keeps state and what was learnt. Throws as the constructor, and changes nothing then.
  void set_params(const Params& params);

  /// Takes the state from odometry of `time`, and observes. The angular velocity remains the
  /// gyroscope's. One that is a little ahead of the samples is waited for.
  void correct(Time time, const RigidBodyState& odometry);

  /// Moves the state on to `now`.
  void advance(Time now, const ImuSample& imu);

  /// Odometry is missed: from now on and until it is back, the state is the observer's.
  void let_go();

  /// The angular velocity is that of the last good sample, as it was measured.
  const RigidBodyState& state() const { return state_; }
  /// Whether velocity and position were carried on without a gap since the last odometry.
  bool motion_known() const { return motion_known_; }

  /// Learnt errors, in the body: measured minus true [m/s^2], [rad/s].
  const Eigen::Vector3d& accelerometer_error() const { return accelerometer_error_; }
  const Eigen::Vector3d& gyroscope_error() const { return gyroscope_error_; }

 private:
  /// What is carried on with the IMU alone.
  struct Motion {
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  };
  static Motion carried(const Motion& from, const ImuSample& mean, double dt);
  void observe(Time time, const RigidBodyState& odometry);
  ImuSample corrected(const ImuSample& sample) const;

  Params params_;
  RigidBodyState state_;
  std::optional<Time> time_;           // of the state
  std::optional<Time> odometry_time_;  // of the last odometry
  Motion observed_;                    // at the time of the state
  double observed_for_ = 0.0;          // [s]
  bool let_go_ = false;
  ImuSample imu_{Eigen::Vector3d::Zero(), {0.0, 0.0, kGravity}};  // last good one
  bool has_imu_ = false;
  double without_sample_ = 0.0;  // since the last good acceleration [s]
  bool motion_known_ = false;
  Eigen::Vector3d accelerometer_error_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyroscope_error_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet
