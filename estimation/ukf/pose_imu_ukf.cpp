// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/ukf/pose_imu_ukf.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
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

// Sigma points: the centre and a pair along each column of the covariance's square root. A
// positive kappa keeps all weights positive.
constexpr int kPoints = 2 * PoseImuUkf::kDim + 1;
constexpr double kKappa = 1.0;
constexpr double kSpread2 = PoseImuUkf::kDim + kKappa;
constexpr double kCentreWeight = kKappa / kSpread2;
constexpr double kWeight = 0.5 / kSpread2;
constexpr int kMeanIterations = 5;

// A quaternion further from unit length than this was not meant as an attitude.
constexpr double kQuaternionTolerance = 0.01;
// Variances outside of this range are a mistake in units or a sentinel.
constexpr double kMinVariance = 1e-14;
constexpr double kMaxVariance = 1e8;

/// Seconds from one moment to another, also where their difference does not fit 64 bits.
double seconds_between(Time from, Time to) {
  const double rough = to_seconds(to) - to_seconds(from);
  return std::abs(rough) > 1e6 ? rough : to_seconds(to - from);
}

Error refused(std::string reason) {
  return Error{std::move(reason)};
}

/// Discrete process noise over `dt`: v_Omega, v_a and v_b of equation 10 as white noise. Isotropic,
/// so that it is the same in body and world axes.
PoseImuUkf::Covariance process_noise(const PoseImuUkf::Params& params, double dt) {
  const double gyro = params.gyro_noise * params.gyro_noise;
  const double accelerometer = params.accelerometer_noise * params.accelerometer_noise;
  const double bias = params.bias_random_walk * params.bias_random_walk;
  PoseImuUkf::Covariance Q = PoseImuUkf::Covariance::Zero();
  for (int i = 0; i < 3; ++i) {
    Q(kPosition + i, kPosition + i) = accelerometer * dt * dt * dt / 3.0;
    Q(kPosition + i, kVelocity + i) = accelerometer * dt * dt / 2.0;
    Q(kVelocity + i, kPosition + i) = accelerometer * dt * dt / 2.0;
    Q(kVelocity + i, kVelocity + i) = accelerometer * dt;
    Q(kAttitude + i, kAttitude + i) = gyro * dt;
    Q(kBias + i, kBias + i) = bias * dt;
  }
  return Q;
}

}  // namespace

PoseImuUkf::PoseImuUkf(const Params& params) : params_(params) {
  const double positive[] = {params.gyro_noise,
                             params.accelerometer_noise,
                             params.bias_random_walk,
                             params.initial_velocity_sigma,
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
}

Status PoseImuUkf::check(const PoseMeasurement& z) const {
  if (!z.p_WB.allFinite()) return refused("position is not finite");
  if (z.p_WB.cwiseAbs().maxCoeff() > params_.max_position) {
    return refused(fmt::format("position beyond {} m", params_.max_position));
  }
  if (!z.q_WB.coeffs().allFinite()) return refused("quaternion is not finite");
  if (!(std::abs(z.q_WB.coeffs().stableNorm() - 1.0) <= kQuaternionTolerance)) {
    return refused(fmt::format("quaternion of length {}", z.q_WB.coeffs().stableNorm()));
  }
  if (!z.covariance.allFinite()) return refused("covariance is not finite");
  const Vector6d variances = z.covariance.diagonal();
  if (variances.minCoeff() < kMinVariance || variances.maxCoeff() > kMaxVariance) {
    return refused(fmt::format("covariance with variances from {} to {}", variances.minCoeff(),
                               variances.maxCoeff()));
  }
  const double asymmetry = (z.covariance - z.covariance.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-6 * variances.maxCoeff()) return refused("covariance is not symmetric");
  if (Eigen::LLT<Matrix6d>(z.covariance).info() != Eigen::Success) {
    return refused("covariance is not positive definite");
  }
  return {};
}

Status PoseImuUkf::initialize(Time time, const PoseMeasurement& measurement) {
  if (Status status = check(measurement); !status) return status;
  *this = PoseImuUkf(params_);
  covariance_.block<3, 3>(kBias, kBias) =
      Matrix3d::Identity() * std::pow(params_.initial_accelerometer_bias_sigma, 2);
  time_ = time;
  restart(time, measurement);
  initialized_ = true;
  return {};
}

/// Position, velocity and attitude from `measurement`; the bias is kept, its correlations are not.
void PoseImuUkf::restart(Time time, const PoseMeasurement& measurement) {
  p_WB_ = measurement.p_WB;
  q_WB_ = measurement.q_WB.normalized();
  v_WB_W_.setZero();
  const Matrix3d bias_covariance = covariance_.block<3, 3>(kBias, kBias);
  covariance_.setZero();
  covariance_.block<3, 3>(kPosition, kPosition) = measurement.covariance.topLeftCorner<3, 3>();
  covariance_.block<3, 3>(kPosition, kAttitude) = measurement.covariance.topRightCorner<3, 3>();
  covariance_.block<3, 3>(kAttitude, kPosition) = measurement.covariance.bottomLeftCorner<3, 3>();
  covariance_.block<3, 3>(kAttitude, kAttitude) = measurement.covariance.bottomRightCorner<3, 3>();
  covariance_.block<3, 3>(kVelocity, kVelocity) =
      Matrix3d::Identity() * std::pow(params_.initial_velocity_sigma, 2);
  covariance_.block<3, 3>(kBias, kBias) = bias_covariance;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  time_ = std::max(time_, time);
  last_measurement_time_ = time_;
  rejected_count_ = 0;
}

Status PoseImuUkf::predict(Time time, const ImuSample& imu) {
  if (!initialized_) return refused("IMU sample before the first pose");
  if (!imu.angular_velocity.allFinite() || !imu.specific_force.allFinite()) {
    return refused("IMU sample is not finite");
  }
  if (imu.angular_velocity.stableNorm() > params_.max_angular_velocity ||
      imu.specific_force.stableNorm() > params_.max_specific_force) {
    return refused(fmt::format("IMU sample with {:.3g} rad/s and {:.3g} m/s^2 is not believable",
                               imu.angular_velocity.stableNorm(), imu.specific_force.stableNorm()));
  }
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

/// A matrix S with S S^T = covariance. Where rounding made the covariance indefinite, it becomes
/// the nearest one (in the Frobenius norm) with eigenvalues above a floor.
PoseImuUkf::Covariance PoseImuUkf::square_root() {
  const Eigen::LLT<Covariance> cholesky(covariance_);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixL();
  const Eigen::SelfAdjointEigenSolver<Covariance> eigen(covariance_);
  const double floor = std::max(1e-12 * eigen.eigenvalues().maxCoeff(), 1e-18);
  const ErrorVector eigenvalues = eigen.eigenvalues().cwiseMax(floor);
  const Covariance& V = eigen.eigenvectors();
  covariance_ = V * eigenvalues.asDiagonal() * V.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  ++covariance_repairs_;
  return V * eigenvalues.cwiseSqrt().asDiagonal();
}

/// Equation 10 through the sigma points. The input is constant in the body over `dt`, for which
/// the integrals over the turning body are known in closed form.
bool PoseImuUkf::propagate(double dt, const ImuSample& input) {
  if (dt == 0.0) return true;
  const Vector3d turn = input.angular_velocity * dt;
  const Quaterniond dq = exp_so3(turn);
  const Matrix3d velocity_gain = left_jacobian_so3(turn) * dt;
  const Matrix3d position_gain = left_jacobian_integral_so3(turn) * (dt * dt);
  const Vector3d gravity(0.0, 0.0, -kGravity);
  const Covariance S = std::sqrt(kSpread2) * square_root();

  Eigen::Matrix<double, kDim, kPoints> points;  // attitude rows: filled below
  std::array<Quaterniond, kPoints> attitudes;
  for (int i = 0; i < kPoints; ++i) {
    ErrorVector error = ErrorVector::Zero();
    if (i > 0) error = i <= kDim ? ErrorVector(S.col(i - 1)) : ErrorVector(-S.col(i - 1 - kDim));
    const Quaterniond q = exp_so3(error.segment<3>(kAttitude)) * q_WB_;
    const Matrix3d R = q.toRotationMatrix();
    const Vector3d v = v_WB_W_ + error.segment<3>(kVelocity);
    const Vector3d bias = accelerometer_bias_ + error.segment<3>(kBias);
    const Vector3d f = input.specific_force - bias;
    points.block<3, 1>(kPosition, i) = p_WB_ + error.segment<3>(kPosition) + v * dt +
                                       R * (position_gain * f) + 0.5 * dt * dt * gravity;
    points.block<3, 1>(kVelocity, i) = v + R * (velocity_gain * f) + gravity * dt;
    points.block<3, 1>(kBias, i) = bias;
    attitudes[static_cast<std::size_t>(i)] = q * dq;
  }

  // Attitude mean: the rotation from which the weighted deviations cancel.
  Quaterniond mean_attitude = attitudes[0];
  for (int iteration = 0; iteration < kMeanIterations; ++iteration) {
    Vector3d correction = Vector3d::Zero();
    const Quaterniond inverse = mean_attitude.conjugate();
    for (int i = 0; i < kPoints; ++i) {
      const Vector3d deviation = log_so3(attitudes[static_cast<std::size_t>(i)] * inverse);
      points.block<3, 1>(kAttitude, i) = deviation;
      correction += (i == 0 ? kCentreWeight : kWeight) * deviation;
    }
    if (correction.squaredNorm() < 1e-24) break;
    mean_attitude = exp_so3(correction) * mean_attitude;
  }

  // The attitude rows hold deviations already; their mean is zero.
  ErrorVector mean =
      kCentreWeight * points.col(0) + kWeight * points.rightCols<2 * kDim>().rowwise().sum();
  mean.segment<3>(kAttitude).setZero();
  points.colwise() -= mean;
  Covariance covariance = process_noise(params_, dt);
  covariance += kWeight * points.rightCols<2 * kDim>() * points.rightCols<2 * kDim>().transpose();
  covariance += kCentreWeight * points.col(0) * points.col(0).transpose();
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  if (!covariance.allFinite() || !mean.allFinite()) return false;

  p_WB_ = mean.segment<3>(kPosition);
  v_WB_W_ = mean.segment<3>(kVelocity);
  accelerometer_bias_ = mean.segment<3>(kBias);
  q_WB_ = mean_attitude.normalized();
  covariance_ = covariance;
  return true;
}

/// Equation 11. In the error state the measurement is the error's position and attitude rows and
/// nothing else, so H is linear and constant, and the Kalman update is what sigma points would
/// give, without them.
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
  innovation << measurement.p_WB - p_WB_,
      log_so3(measurement.q_WB.normalized() * q_WB_.conjugate());
  Eigen::Matrix<double, kDim, 6> PHt;
  PHt << covariance_.middleCols<3>(kPosition), covariance_.middleCols<3>(kAttitude);
  const Matrix6d& R = measurement.covariance;
  Matrix6d S = R;
  S.topRows<3>() += PHt.middleRows<3>(kPosition);
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

  Eigen::Matrix<double, kDim, 6> K = cholesky.solve(PHt.transpose()).transpose();
  const ErrorVector correction = K * innovation;
  // Joseph form, which stays positive definite; then the errors are counted from the corrected
  // attitude, which turns their axes by the left Jacobian.
  Covariance A = Covariance::Identity();
  A.middleCols<3>(kPosition) -= K.leftCols<3>();
  A.middleCols<3>(kAttitude) -= K.rightCols<3>();
  const Matrix3d J = left_jacobian_so3(correction.segment<3>(kAttitude));
  A.middleRows<3>(kAttitude) = (J * A.middleRows<3>(kAttitude)).eval();
  K.middleRows<3>(kAttitude) = (J * K.middleRows<3>(kAttitude)).eval();
  Covariance covariance = A * covariance_ * A.transpose() + K * R * K.transpose();
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  if (!covariance.allFinite() || !correction.allFinite()) return refuse("update is not finite");

  p_WB_ += correction.segment<3>(kPosition);
  v_WB_W_ += correction.segment<3>(kVelocity);
  q_WB_ = (exp_so3(correction.segment<3>(kAttitude)) * q_WB_).normalized();
  accelerometer_bias_ += correction.segment<3>(kBias);
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
