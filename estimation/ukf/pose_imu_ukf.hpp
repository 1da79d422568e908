// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// A measured pose of the body in the world.
struct PoseMeasurement {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();            ///< [m]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  ///< unit, body to world
  /// Position [m^2], then rotation about the world's axes [rad^2], as geometry_msgs has it.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
};

/// What became of one measurement.
struct UpdateReport {
  enum class Outcome {
    kUsed,           ///< the state was corrected
    kRejected,       ///< outside the innovation gate; no correction
    kRefused,        ///< unusable (not finite, wrong time, ...); state untouched
    kReinitialized,  ///< rejected for too long: the state was restarted from this measurement
  };
  Outcome outcome = Outcome::kRefused;
  /// Normalised innovation squared: chi-square with 6 degrees of freedom where the filter is
  /// consistent. Zero where there was no innovation to compute.
  double nis = 0.0;
  std::string reason;  ///< empty where the measurement was used
};

/// Unscented Kalman filter on pose and IMU: equations 7 to 11 of seed 000.
///
/// State: position, velocity, attitude and accelerometer bias as in equation 7; beyond the paper,
/// the bias of the gyroscope, and the slow drift of the measured position. The IMU is the input u
/// of equation 10, the pose is the measurement z of equation 11. Gravity is known.
///
/// On the manifold: the filter keeps a unit quaternion and an 18-dimensional error,
///
///     [0..2]   position error     [m]      p_WB = estimate + error
///     [3..5]   velocity error     [m/s]    v_WB_W = estimate + error
///     [6..8]   attitude error     [rad]    q_WB = exp(error) * estimate, about the world's axes
///     [9..11]  bias error         [m/s^2]  accelerometer, body axes
///     [12..14] bias error         [rad/s]  gyroscope, body axes
///     [15..17] drift error        [m]      of the measured position, world axes
///
/// The drift is a first-order Gauss-Markov process in its stationary state. It has a share of the
/// position variance that the measurements state; without a share (the default) it stays zero.
///
/// All weights of the sigma points are positive, so the predicted covariance is a sum of squares.
///
/// A value type without hidden state: a copy continues exactly as the original does. DelayedUkf
/// uses that for measurements that arrive late.
class PoseImuUkf {
 public:
  static constexpr int kDim = 18;
  using ErrorVector = Eigen::Matrix<double, kDim, 1>;
  using Covariance = Eigen::Matrix<double, kDim, kDim>;
  using Outcome = UpdateReport::Outcome;

  struct Params {
    double gyro_noise = 2e-3;             ///< density [rad/s/sqrt(Hz)]
    double accelerometer_noise = 2e-2;    ///< density [m/s^2/sqrt(Hz)]
    double bias_random_walk = 2e-3;       ///< of the accelerometer, density [m/s^3/sqrt(Hz)]
    double gyro_bias_random_walk = 1e-4;  ///< density [rad/s^2/sqrt(Hz)]

    double initial_velocity_sigma = 0.5;            ///< [m/s]
    double initial_accelerometer_bias_sigma = 0.2;  ///< [m/s^2]
    double initial_gyro_bias_sigma = 0.01;          ///< [rad/s]

    /// Share of the measured positions' variance that is slow drift, in [0, 1).
    double drift_share = 0.0;
    double drift_time_constant = 10.0;  ///< [s]

    /// Largest NIS that is believed: the 99.9 % quantile of chi-square with 6 degrees of freedom.
    double gate = 22.458;
    /// Rejections in a row, and how long they must last, before position, velocity and attitude
    /// are restarted from a measurement. The biases are kept.
    int reset_count = 5;
    double reset_after = 0.5;  ///< [s]
    /// Two rejected measurements further apart than this do not support each other [m].
    double reset_agreement = 0.5;

    double max_step = 0.1;              ///< longest gap that prediction bridges [s]
    double max_measurement_age = 0.02;  ///< older than the state by more: refused [s]
    double max_angular_velocity = 60;   ///< of a believable IMU sample [rad/s]
    double max_specific_force = 400;    ///< of a believable IMU sample [m/s^2]
    double max_position = 1e6;          ///< of a believable measurement, each axis [m]
  };

  /// Throws std::invalid_argument where a parameter is not finite or not positive.
  explicit PoseImuUkf(const Params& params);
  PoseImuUkf() : PoseImuUkf(Params{}) {}

  /// Starts from a measured pose at rest. Refuses what `update` would refuse.
  Status initialize(Time time, const PoseMeasurement& measurement);

  /// Whether a sample is finite and within what the parameters call believable.
  Status check(const ImuSample& imu) const;
  /// Moves the state to `time` (equation 10) with the mean of this and the previous sample, which
  /// is exact for constant samples and of second order otherwise. Refused, with the state as it
  /// was: before `initialize`, samples that are not finite or not believable, time that runs
  /// backwards or jumps by more than `max_step`.
  Status predict(Time time, const ImuSample& imu);

  /// Corrects the state (equation 11). A measurement that is newer than the state first moves the
  /// state to its time with the latest IMU sample; one that is older by no more than
  /// `max_measurement_age` counts as current.
  UpdateReport update(Time time, const PoseMeasurement& measurement);

  bool initialized() const { return initialized_; }
  Time time() const { return time_; }
  /// Time of the last measurement that was used, or that the state was (re-)started from.
  Time last_measurement_time() const { return last_measurement_time_; }
  /// The angular velocity is that of the last IMU sample, less the bias.
  RigidBodyState state() const {
    return {p_WB_, q_WB_, v_WB_W_, imu_.angular_velocity - gyro_bias_};
  }
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }
  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }
  /// By how much measured positions are off at present, beside their white noise [m].
  const Eigen::Vector3d& drift() const { return drift_; }
  const Covariance& covariance() const { return covariance_; }
  /// Position and attitude blocks, in the order and the axes of PoseMeasurement::covariance.
  Eigen::Matrix<double, 6, 6> pose_covariance() const;
  /// How often the covariance had to be made positive definite again. Zero in health.
  std::uint64_t covariance_repairs() const { return covariance_repairs_; }

 private:
  Status check(const PoseMeasurement& measurement) const;
  bool propagate(double dt, const ImuSample& input);
  void restart(Time time, const PoseMeasurement& measurement);
  UpdateReport reject(Time time, const PoseMeasurement& measurement, UpdateReport report);
  Eigen::Matrix<double, 6, 6> white_covariance(const PoseMeasurement& measurement) const;
  bool factorise_turning(Eigen::Matrix<double, 6, 6>& S);

  Params params_;
  bool initialized_ = false;
  Time time_{};
  Time last_measurement_time_{};
  Eigen::Vector3d p_WB_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d accelerometer_bias_ = Eigen::Vector3d::Zero();
  Covariance covariance_ = Covariance::Identity();
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d drift_covariance_ = Eigen::Matrix3d::Zero();  ///< in the stationary state
  bool have_imu_ = false;
  ImuSample imu_;
  std::uint64_t covariance_repairs_ = 0;

  // The run of rejected measurements that support each other.
  int rejected_count_ = 0;
  Time rejected_since_{};
  Time rejected_last_{};
  Eigen::Vector3d rejected_position_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet
