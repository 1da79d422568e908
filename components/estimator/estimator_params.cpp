// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/estimator/estimator_params.hpp"

namespace swiftlet {

EstimatorParams read_estimator_params(const Config& config) {
  EstimatorParams params;
  PoseImuUkf::Params& ukf = params.filter.ukf;
  config.read("gyro_noise", ukf.gyro_noise, kPositive);
  config.read("accelerometer_noise", ukf.accelerometer_noise, kPositive);
  config.read("bias_random_walk", ukf.bias_random_walk, kPositive);
  config.read("gyro_bias_random_walk", ukf.gyro_bias_random_walk, kPositive);
  config.read("initial_velocity_sigma", ukf.initial_velocity_sigma, kPositive);
  config.read("initial_accelerometer_bias_sigma", ukf.initial_accelerometer_bias_sigma, kPositive);
  config.read("initial_gyro_bias_sigma", ukf.initial_gyro_bias_sigma, kPositive);
  config.read("drift_share", ukf.drift_share, {0.0, 0.99});
  config.read("drift_time_constant", ukf.drift_time_constant, kPositive);
  config.read("gate", ukf.gate, kPositive);
  config.read("reset_count", ukf.reset_count, {1, 1000});
  config.read("reset_after", ukf.reset_after, kPositive);
  config.read("max_delay", params.filter.max_delay, {0.001, 1.0});
  config.read("odometry_every", params.odometry_every, {1, 1000});
  return params;
}

}  // namespace swiftlet
