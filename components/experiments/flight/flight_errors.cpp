// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/flight/flight_errors.hpp"

#include <Eigen/Cholesky>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {

double psi(const Eigen::Quaterniond& q, const Eigen::Quaterniond& q_d) {
  // 1 - cos(angle) = 2 sin^2(angle / 2).
  return 2.0 * (q_d.conjugate() * q).vec().squaredNorm();
}

double pose_nees(const FlightMoment& moment) {
  Eigen::Matrix<double, 6, 1> error;
  error << moment.truth.p_WB - moment.estimate.p_WB,
      log_so3(moment.truth.q_WB * moment.estimate.q_WB.conjugate());
  return error.dot(moment.pose_covariance.ldlt().solve(error));
}

double velocity_nees(const FlightMoment& moment) {
  const Eigen::Vector3d error =
      moment.estimate.q_WB.conjugate() * (moment.truth.v_WB_W - moment.estimate.v_WB_W);
  return error.dot(moment.velocity_covariance_B.ldlt().solve(error));
}

}  // namespace swiftlet
