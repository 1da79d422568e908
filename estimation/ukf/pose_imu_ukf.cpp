// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/ukf/pose_imu_ukf.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// First rows of the blocks of the error state, see the header.
constexpr int kPosition = 0;
constexpr int kVelocity = 3;
constexpr int kAttitude = 6;
constexpr int kBias = 9;
constexpr int kGyroBias = 12;
constexpr int kDrift = 15;

// Sigma points over what the motion is not linear in, the attitude and the accelerometer's bias:
// the centre and a pair along each column of their covariance's square root. A positive kappa keeps
// all weights positive.
constexpr int kTurning = 6;
constexpr double kKappa = 1.0;
constexpr double kSpread2 = kTurning + kKappa;
constexpr double kCentreWeight = kKappa / kSpread2;
constexpr double kPairWeight = 1.0 / kSpread2;  // of the two together

/// Seconds from one moment to another, also where their difference does not fit 64 bits.
double seconds_between(Time from, Time to) {
  const double rough = to_seconds(to) - to_seconds(from);
  return std::abs(rough) > 1e6 ? rough : to_seconds(to - from);
}

using Measured = Eigen::Matrix<double, PoseImuUkf::kDim, 6>;

/// P H^T: what the measured errors, position plus drift and attitude, have to do with all others.
Measured measured_columns(const PoseImuUkf::Covariance& P) {
  Measured columns;
  columns << P.middleCols<3>(kPosition) + P.middleCols<3>(kDrift), P.middleCols<3>(kAttitude);
  return columns;
}

void symmetrise(PoseImuUkf::Covariance& P) {
  for (int j = 0; j < PoseImuUkf::kDim; ++j) {
    for (int i = 0; i < j; ++i) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

/// At this size, and with lazyProduct, half the time of Eigen's blocked solvers and products.
Matrix6d inverse_of_lower(const Matrix6d& L) {
  Matrix6d inverse;
  for (int j = 0; j < 6; ++j) {
    inverse.col(j) = L.triangularView<Eigen::Lower>().solve(Vector6d::Unit(j));
  }
  return inverse;
}

Error refused(std::string reason) {
  return Error{std::move(reason)};
}

/// Adds to `P` the discrete process noise over `dt`: v_Omega, v_a and v_b of equation 10 as white
/// noise. Isotropic, so that it is the same in body and world axes.
void add_process_noise(const PoseImuUkf::Params& params, double dt, PoseImuUkf::Covariance& P) {
  const double gyro = params.gyro_noise * params.gyro_noise;
  const double accelerometer = params.accelerometer_noise * params.accelerometer_noise;
  const double bias = params.bias_random_walk * params.bias_random_walk;
  const double gyro_bias = params.gyro_bias_random_walk * params.gyro_bias_random_walk;
  for (int i = 0; i < 3; ++i) {
    P(kPosition + i, kPosition + i) += accelerometer * dt * dt * dt / 3.0;
    P(kPosition + i, kVelocity + i) += accelerometer * dt * dt / 2.0;
    P(kVelocity + i, kPosition + i) += accelerometer * dt * dt / 2.0;
    P(kVelocity + i, kVelocity + i) += accelerometer * dt;
    P(kAttitude + i, kAttitude + i) += gyro * dt;
    P(kBias + i, kBias + i) += bias * dt;
    P(kGyroBias + i, kGyroBias + i) += gyro_bias * dt;
  }
}

}  // namespace

PoseImuUkf::PoseImuUkf(const Params& params) : params_(params) {
  const double positive[] = {params.gyro_noise,
                             params.accelerometer_noise,
                             params.bias_random_walk,
                             params.gyro_bias_random_walk,
                             params.initial_velocity_sigma,
                             params.initial_gyro_bias_sigma,
                             params.drift_time_constant,
                             params.gate,
                             params.initial_accelerometer_bias_sigma,
                             params.max_step,
                             params.reset_after,
                             params.reset_agreement,
                             params.max_measurement_age,
                             params.max_specific_force,
                             params.max_angular_velocity,
                             params.max_position,
                             static_cast<double>(params.reset_count)};
  for (const double value : positive) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument("UKF: every parameter must be positive and finite");
    }
  }
  if (!(params.drift_share >= 0.0 && params.drift_share < 1.0)) {
    throw std::invalid_argument("UKF: the drift's share of the variance is in [0, 1)");
  }
}

Status PoseImuUkf::initialize(Time time, const PoseMeasurement& measurement) {
  if (Status status = check(measurement); !status) return status;
  *this = PoseImuUkf(params_);
  covariance_.block<3, 3>(kBias, kBias) =
      Matrix3d::Identity() * std::pow(params_.initial_accelerometer_bias_sigma, 2);
  covariance_.block<3, 3>(kGyroBias, kGyroBias) =
      Matrix3d::Identity() * std::pow(params_.initial_gyro_bias_sigma, 2);
  time_ = time;
  restart(time, measurement);
  initialized_ = true;
  return {};
}

/// Position, velocity and attitude from `measurement`; the biases are kept, their correlations with
/// the rest are not.
void PoseImuUkf::restart(Time time, const PoseMeasurement& measurement) {
  p_WB_ = measurement.p_WB;
  q_WB_ = measurement.q_WB.normalized();
  v_WB_W_.setZero();
  drift_.setZero();
  drift_covariance_ = params_.drift_share * measurement.covariance.topLeftCorner<3, 3>();
  const Matrix6d biases = covariance_.block<6, 6>(kBias, kBias);
  covariance_.setZero();
  covariance_.block<3, 3>(kPosition, kPosition) = measurement.covariance.topLeftCorner<3, 3>();
  covariance_.block<3, 3>(kPosition, kAttitude) = measurement.covariance.topRightCorner<3, 3>();
  covariance_.block<3, 3>(kAttitude, kPosition) = measurement.covariance.bottomLeftCorner<3, 3>();
  covariance_.block<3, 3>(kAttitude, kAttitude) = measurement.covariance.bottomRightCorner<3, 3>();
  covariance_.block<3, 3>(kVelocity, kVelocity) =
      Matrix3d::Identity() * std::pow(params_.initial_velocity_sigma, 2);
  covariance_.block<6, 6>(kBias, kBias) = biases;
  // A measurement that is off by the drift puts the position off by its opposite.
  covariance_.block<3, 3>(kDrift, kDrift) = drift_covariance_;
  covariance_.block<3, 3>(kPosition, kDrift) = -drift_covariance_;
  covariance_.block<3, 3>(kDrift, kPosition) = -drift_covariance_;
  symmetrise(covariance_);
  time_ = std::max(time_, time);
  last_measurement_time_ = time_;
  rejected_count_ = 0;
}

/// What of a measurement's covariance is white: all but the drift's share.
Matrix6d PoseImuUkf::white_covariance(const PoseMeasurement& measurement) const {
  Matrix6d R = measurement.covariance;
  R.topLeftCorner<3, 3>() *= 1.0 - params_.drift_share;
  return R;
}

Status PoseImuUkf::predict(Time time, const ImuSample& imu) {
  if (!initialized_) return refused("IMU sample before the first pose");
  if (Status status = check(imu); !status) return status;
  const double dt = seconds_between(time_, time);
  if (dt < 0.0) return refused(fmt::format("IMU time runs backwards by {:.6g} s", -dt));
  if (dt > params_.max_step) {
    return refused(fmt::format("IMU time jumps by {:.6g} s, more than {} s", dt, params_.max_step));
  }
  ImuSample input = imu;
  if (have_imu_) {
    input.angular_velocity = 0.5 * (imu_.angular_velocity + imu.angular_velocity);
    input.specific_force = 0.5 * (imu_.specific_force + imu.specific_force);
  }
  if (!propagate(dt, input)) return refused("prediction is not finite");
  time_ = time;
  imu_ = imu;
  have_imu_ = true;
  return {};
}

/// The lower triangular S with S S^T the covariance of attitude and accelerometer bias. Where
/// rounding made that indefinite, the whole covariance becomes the nearest one (in the Frobenius
/// norm) with eigenvalues above a floor.
bool PoseImuUkf::factorise_turning(Matrix6d& S) {
  Eigen::LLT<Matrix6d> cholesky(covariance_.block<kTurning, kTurning>(kAttitude, kAttitude));
  if (cholesky.info() != Eigen::Success) {
    const Eigen::SelfAdjointEigenSolver<Covariance> eigen(covariance_);
    const double floor = std::max(1e-12 * eigen.eigenvalues().maxCoeff(), 1e-18);
    const Covariance& V = eigen.eigenvectors();
    covariance_ = V * eigen.eigenvalues().cwiseMax(floor).asDiagonal() * V.transpose();
    symmetrise(covariance_);
    ++covariance_repairs_;
    cholesky.compute(covariance_.block<kTurning, kTurning>(kAttitude, kAttitude));
  }
  S = cholesky.matrixL();
  return cholesky.info() == Eigen::Success;
}

/// Equation 10. The input is constant in the body over `dt`, for which the integrals over the
/// turning body are known in closed form: what it adds to position and velocity is
/// g = R(attitude) gain (specific force - bias), the only part that is not linear in the error.
/// That part goes through the sigma points, the rest exactly: the transform of a function is
/// known when it is known for the part of the state that it bends.
bool PoseImuUkf::propagate(double dt, const ImuSample& input) {
  if (dt == 0.0) return true;
  const Vector3d turn = (input.angular_velocity - gyro_bias_) * dt;
  const Matrix3d turn_jacobian = left_jacobian_so3(turn);
  const Matrix3d velocity_gain = turn_jacobian * dt;
  const Matrix3d position_gain = left_jacobian_integral_so3(turn) * (dt * dt);
  const Vector3d f = input.specific_force - accelerometer_bias_;
  Eigen::Matrix<double, 6, 3> gain;
  gain << position_gain, velocity_gain;
  const auto g = [&](const Quaterniond& turned, const Vector3d& bias_error) {
    const Matrix3d R = (turned * q_WB_).toRotationMatrix();
    const Vector6d in_body = gain * (f - bias_error);
    Vector6d added;
    added << R * in_body.head<3>(), R * in_body.tail<3>();
    return added;
  };

  Matrix6d S;
  if (!factorise_turning(S)) return false;
  const double spread = std::sqrt(kSpread2);
  const Vector6d centre = g(Quaterniond::Identity(), Vector3d::Zero());
  Matrix6d odd, even;  // halves of the differences and of the sums of each pair
  for (int j = 0; j < kTurning; ++j) {
    const Vector3d bias_error = spread * S.block<3, 1>(3, j);
    if (j < 3) {
      const Quaterniond turned = exp_so3(spread * S.block<3, 1>(0, j));
      const Vector6d ahead = g(turned, bias_error), behind = g(turned.conjugate(), -bias_error);
      odd.col(j) = 0.5 * (ahead - behind);
      even.col(j) = 0.5 * (ahead + behind);
    } else {  // S is triangular: nothing is turned, and in the bias g is linear
      odd.col(j) = g(Quaterniond::Identity(), bias_error) - centre;
      even.col(j) = centre;
    }
  }
  const Vector6d mean = kCentreWeight * centre + kPairWeight * even.rowwise().sum();
  even.colwise() -= mean;
  const Vector6d off_centre = centre - mean;
  // The odd parts are those of the linear function G; the even ones are the rest of the covariance.
  const Matrix6d G = odd.lazyProduct(inverse_of_lower(S)) / spread;
  const Matrix6d bent =
      kPairWeight * even * even.transpose() + kCentreWeight * off_centre * off_centre.transpose();

  const Matrix3d R = q_WB_.toRotationMatrix();
  const Matrix3d turned = -R * turn_jacobian * dt;    // attitude by gyroscope bias
  const Matrix3d swept = 0.5 * dt * dt * R * hat(f);  // velocity by gyroscope bias
  const double kept = std::exp(-dt / params_.drift_time_constant);

  // F P F^T, by the blocks in which F differs from the identity. In this order none is needed again
  // once it is changed.
  Covariance next = covariance_;
  next.middleRows<3>(kPosition) += dt * next.middleRows<3>(kVelocity) +
                                   G.topRows<3>() * next.middleRows<6>(kAttitude) +
                                   dt / 3.0 * swept * next.middleRows<3>(kGyroBias);
  next.middleRows<3>(kVelocity) +=
      G.bottomRows<3>() * next.middleRows<6>(kAttitude) + swept * next.middleRows<3>(kGyroBias);
  next.middleRows<3>(kAttitude) += turned * next.middleRows<3>(kGyroBias);
  next.middleRows<3>(kDrift) *= kept;
  next.middleCols<3>(kPosition) += dt * next.middleCols<3>(kVelocity) +
                                   next.middleCols<6>(kAttitude) * G.topRows<3>().transpose() +
                                   next.middleCols<3>(kGyroBias) * (dt / 3.0 * swept.transpose());
  next.middleCols<3>(kVelocity) += next.middleCols<6>(kAttitude) * G.bottomRows<3>().transpose() +
                                   next.middleCols<3>(kGyroBias) * swept.transpose();
  next.middleCols<3>(kAttitude) += next.middleCols<3>(kGyroBias) * turned.transpose();
  next.middleCols<3>(kDrift) *= kept;
  next.topLeftCorner<6, 6>() += bent;
  add_process_noise(params_, dt, next);
  next.block<3, 3>(kDrift, kDrift) += (1.0 - kept * kept) * drift_covariance_;
  symmetrise(next);
  if (!next.allFinite() || !mean.allFinite()) return false;

  const Vector3d gravity(0.0, 0.0, -kGravity);
  p_WB_ += dt * v_WB_W_ + 0.5 * dt * dt * gravity + mean.head<3>();
  v_WB_W_ += dt * gravity + mean.tail<3>();
  q_WB_ = (q_WB_ * exp_so3(turn)).normalized();
  drift_ *= kept;
  covariance_ = next;
  return true;
}

/// Equation 11. In the error state the measurement is position plus drift, and attitude, so H is
/// linear and constant, and the Kalman update is what sigma points would give, without them.
UpdateReport PoseImuUkf::update(Time time, const PoseMeasurement& measurement) {
  UpdateReport report;
  const auto refuse = [&report](std::string reason) {
    report.outcome = Outcome::kRefused;
    report.reason = std::move(reason);
    return report;
  };
  if (!initialized_) return refuse("the filter has no first pose yet");
  if (Status status = check(measurement); !status) return refuse(status.error().reason);
  const double ahead = seconds_between(time_, time);
  if (-ahead > params_.max_measurement_age) {
    return refuse(fmt::format("pose is {:.6g} s older than the state", -ahead));
  }
  if (ahead > params_.max_step) {
    // After a gap of the IMU nothing can bridge it but a fresh start.
    refuse(fmt::format("pose is {:.6g} s ahead of the latest IMU sample", ahead));
    return reject(time, measurement, std::move(report));
  }
  if (ahead > 0.0) {
    if (!have_imu_) return refuse("no IMU sample yet");
    if (!propagate(ahead, imu_)) return refuse("prediction is not finite");
    time_ = time;
  }

  Vector6d innovation;
  innovation << measurement.p_WB - p_WB_ - drift_,
      log_so3(measurement.q_WB.normalized() * q_WB_.conjugate());
  const Measured PHt = measured_columns(covariance_);
  const Matrix6d R = white_covariance(measurement);
  Matrix6d S = R;
  S.topRows<3>() += PHt.middleRows<3>(kPosition) + PHt.middleRows<3>(kDrift);
  S.bottomRows<3>() += PHt.middleRows<3>(kAttitude);
  const Eigen::LLT<Matrix6d> cholesky(S);
  if (cholesky.info() != Eigen::Success) return refuse("innovation covariance is indefinite");
  report.nis = innovation.dot(cholesky.solve(innovation));
  if (!(report.nis <= params_.gate)) {
    report.outcome = Outcome::kRejected;
    report.reason = fmt::format("innovation of {:.3g} m and {:.3g} rad, NIS {:.4g} above {:.4g}",
                                innovation.head<3>().norm(), innovation.tail<3>().norm(),
                                report.nis, params_.gate);
    return reject(time, measurement, std::move(report));
  }

  const Matrix6d root = inverse_of_lower(cholesky.matrixL());
  const Measured whitened = PHt.lazyProduct(root.transpose());
  const Measured K = whitened.lazyProduct(root);
  const ErrorVector correction = K * innovation;
  // Joseph's form (I - K H) P (I - K H)^T + K R K^T, one factor after the other.
  Covariance covariance = covariance_ - K.lazyProduct(PHt.transpose());
  const Measured left = K.lazyProduct(R) - measured_columns(covariance);
  covariance += left.lazyProduct(K.transpose());
  // Errors are counted from the corrected attitude, which turns their axes by the left Jacobian.
  const Matrix3d J = left_jacobian_so3(correction.segment<3>(kAttitude));
  covariance.middleRows<3>(kAttitude) = (J * covariance.middleRows<3>(kAttitude)).eval();
  covariance.middleCols<3>(kAttitude) =
      (covariance.middleCols<3>(kAttitude) * J.transpose()).eval();
  symmetrise(covariance);
  if (!covariance.allFinite() || !correction.allFinite()) return refuse("update is not finite");

  p_WB_ += correction.segment<3>(kPosition);
  v_WB_W_ += correction.segment<3>(kVelocity);
  q_WB_ = (exp_so3(correction.segment<3>(kAttitude)) * q_WB_).normalized();
  accelerometer_bias_ += correction.segment<3>(kBias);
  gyro_bias_ += correction.segment<3>(kGyroBias);
  drift_ += correction.segment<3>(kDrift);
  covariance_ = covariance;
  last_measurement_time_ = time_;
  rejected_count_ = 0;
  report.outcome = Outcome::kUsed;
  return report;
}

/// Counts a rejected measurement; restarts from it where enough of them agree for long enough.
UpdateReport PoseImuUkf::reject(Time time, const PoseMeasurement& measurement,
                                UpdateReport report) {
  const bool supported = rejected_count_ > 0 && time >= rejected_last_ &&
                         (measurement.p_WB - rejected_position_).norm() <= params_.reset_agreement;
  if (!supported) {
    rejected_count_ = 0;
    rejected_since_ = time;
  }
  ++rejected_count_;
  rejected_last_ = time;
  rejected_position_ = measurement.p_WB;
  const double lasted = seconds_between(rejected_since_, time);
  if (rejected_count_ >= params_.reset_count && lasted >= params_.reset_after) {
    report.outcome = Outcome::kReinitialized;
    report.reason = fmt::format("restarted from the pose after {} rejections in {:.3g} s; last: {}",
                                rejected_count_, lasted, report.reason);
    restart(time, measurement);
  }
  return report;
}

Eigen::Matrix<double, 6, 6> PoseImuUkf::pose_covariance() const {
  Matrix6d covariance;
  covariance << covariance_.block<3, 3>(kPosition, kPosition),
      covariance_.block<3, 3>(kPosition, kAttitude), covariance_.block<3, 3>(kAttitude, kPosition),
      covariance_.block<3, 3>(kAttitude, kAttitude);
  return covariance;
}

}  // namespace swiftlet
