// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/sonar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {

namespace {

// Two rings and the axis: a flat floor is seen true within 0.2 % of the range at any tilt that
// keeps its foot in the cone.
constexpr int kRings = 3;
constexpr int kRaysPerRing = 12;

}  // namespace

Sonar::Sonar(const Params& params, RandomStream random)
    : params_(params), random_(random), clock_(params.rate_hz) {
  reading_.range_min = params.range_min;
  reading_.range_max = params.range_max;
  reading_.field_of_view = 2.0 * params.cone_half_angle;
  rays_S_.resize(3, 1 + kRings * kRaysPerRing);
  rays_S_.col(0) = -Eigen::Vector3d::UnitZ();
  for (int i = 0; i < kRings * kRaysPerRing; ++i) {
    const double polar = params.cone_half_angle * (1 + i / kRaysPerRing) / kRings;
    const double azimuth = 2.0 * M_PI * i / kRaysPerRing;
    rays_S_.col(i + 1) << std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
        -std::cos(polar);
  }
  rays_W_ = rays_S_;
}

const RangeReading* Sonar::update(const VehicleTruth& truth, const World& world) {
  if (!clock_.due(truth.time)) return nullptr;
  const Eigen::Quaterniond q_WS = truth.body.q_WB * params_.mount.attitude;
  rays_W_.noalias() = q_WS.toRotationMatrix() * rays_S_;
  world.cast_rays(truth.body.p_WB + truth.body.q_WB * params_.mount.position, rays_W_,
                  params_.range_max, ranges_);
  const double nearest = *std::min_element(ranges_.begin(), ranges_.end());
  const double noise = params_.noise_stddev * random_.normal();
  const bool dropped = random_.uniform() < params_.dropout_probability;
  const double range = quantised(nearest + noise, params_.resolution);
  reading_.time = truth.time;
  reading_.range = dropped || !(range <= params_.range_max)
                       ? std::numeric_limits<double>::infinity()
                       : std::max(range, params_.range_min);
  return &reading_;
}

}  // namespace swiftlet
