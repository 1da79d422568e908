// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/phone_pose.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {

using Eigen::Vector3d;

PhonePoseSensor::PhonePoseSensor(const Params& params, RandomStream random)
    : params_(params), random_(random), clock_(params.rate_hz) {
  drift_ = std::sqrt(params.drift_fraction) * params.position_rmse.cwiseProduct(random_.normal3());
  const double on_the_way = std::ceil(1e-3 * params.latency_ms * params.rate_hz);
  on_the_way_.resize(static_cast<std::size_t>(std::clamp(on_the_way, 0.0, 1e4)) + 2);
}

const PhonePoseReading* PhonePoseSensor::update(const VehicleTruth& truth) {
  if (clock_.due(truth.time)) {
    const PhonePoseReading pose = measure(truth);
    const bool dropped = random_.uniform() < params_.drop_probability;
    if (!dropped && waiting_ < on_the_way_.size()) {
      on_the_way_[(first_ + waiting_++) % on_the_way_.size()] = pose;
    }
  }
  const Duration latency = from_seconds(1e-3 * params_.latency_ms);
  if (waiting_ == 0 || truth.time < on_the_way_[first_].time + latency) return nullptr;
  reading_ = on_the_way_[first_];
  first_ = (first_ + 1) % on_the_way_.size();
  --waiting_;
  return &reading_;
}

PhonePoseReading PhonePoseSensor::measure(const VehicleTruth& truth) {
  const Vector3d drift_stddev = std::sqrt(params_.drift_fraction) * params_.position_rmse;
  const Vector3d white_stddev = std::sqrt(1.0 - params_.drift_fraction) * params_.position_rmse;
  drift_ = gauss_markov_step(drift_, drift_stddev, params_.drift_time_constant,
                             to_seconds(truth.time - drift_time_), random_.normal3());
  drift_time_ = truth.time;

  PhonePoseReading pose;
  pose.time = truth.time;
  pose.position = truth.body.p_WB + truth.body.q_WB * params_.mount.position + drift_ +
                  white_stddev.cwiseProduct(random_.normal3());
  pose.attitude_stddev = {params_.tilt_stddev, params_.tilt_stddev, params_.yaw_stddev};
  const Vector3d n = pose.attitude_stddev.cwiseProduct(random_.normal3());
  pose.attitude = (exp_so3(n) * truth.body.q_WB * params_.mount.attitude).normalized();
  pose.position_stddev = params_.position_rmse;
  return pose;
}

}  // namespace swiftlet
