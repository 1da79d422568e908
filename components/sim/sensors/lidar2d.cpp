// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/lidar2d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {

Lidar2d::Lidar2d(const Params& params, RandomStream random)
    : params_(params), random_(random), clock_(params.rate_hz) {
  const int beams = std::max(params.beams, 1);
  reading_.angle_min = -M_PI;
  reading_.angle_increment = 2.0 * M_PI / beams;
  reading_.range_min = params.range_min;
  reading_.range_max = params.range_max;
  reading_.ranges.resize(static_cast<std::size_t>(beams));
  beams_S_.resize(3, beams);
  for (int i = 0; i < beams; ++i) {
    const double angle = reading_.angle_min + i * reading_.angle_increment;
    beams_S_.col(i) << std::cos(angle), std::sin(angle), 0.0;
  }
  beams_W_ = beams_S_;
}

const LaserScanReading* Lidar2d::update(const VehicleTruth& truth, const World& world) {
  if (!clock_.due(truth.time)) return nullptr;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Eigen::Quaterniond q_WS = truth.body.q_WB * params_.mount.attitude;
  beams_W_.noalias() = q_WS.toRotationMatrix() * beams_S_;
  world.cast_rays(truth.body.p_WB + truth.body.q_WB * params_.mount.position, beams_W_,
                  params_.range_max, true_ranges_);
  reading_.time = truth.time;
  for (std::size_t i = 0; i < true_ranges_.size(); ++i) {
    // Every beam draws the same numbers whatever it meets, so that a change in the world changes
    // the beams that see it and no others.
    const double noise = params_.noise_stddev * random_.normal();
    const bool dropped = random_.uniform() < params_.dropout_probability;
    const double range = quantised(true_ranges_[i] + noise, params_.resolution);
    float& out = reading_.ranges[i];
    if (dropped || !(range <= params_.range_max)) {
      out = kInfinity;
    } else if (range < params_.range_min) {
      out = -kInfinity;
    } else {
      out = static_cast<float>(range);
    }
  }
  return &reading_;
}

}  // namespace swiftlet
