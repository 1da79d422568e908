// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// What the filter does not believe.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <utility>

#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// A quaternion further from unit length than this was not meant as an attitude.
constexpr double kQuaternionTolerance = 0.01;
// Variances outside of this range are a mistake in units or a sentinel.
constexpr double kMinVariance = 1e-14;
constexpr double kMaxVariance = 1e8;

Error refused(std::string reason) {
  return Error{std::move(reason)};
}

}  // namespace

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

Status PoseImuUkf::check(const ImuSample& imu) const {
  if (!imu.angular_velocity.allFinite() || !imu.specific_force.allFinite()) {
    return refused("IMU sample is not finite");
  }
  if (imu.angular_velocity.stableNorm() > params_.max_angular_velocity ||
      imu.specific_force.stableNorm() > params_.max_specific_force) {
    return refused(fmt::format("IMU sample with {:.3g} rad/s and {:.3g} m/s^2 is not believable",
                               imu.angular_velocity.stableNorm(), imu.specific_force.stableNorm()));
  }
  return {};
}

}  // namespace swiftlet
