// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/gps.hpp"

namespace swiftlet {

GpsSensor::GpsSensor(const Params& params, const std::optional<LocalOrigin>& origin,
                     RandomStream random)
    : params_(params), origin_(origin), random_(random), clock_(params.rate_hz) {
  reading_.horizontal_stddev = params.horizontal_stddev;
  reading_.vertical_stddev = params.vertical_stddev;
}

const GpsReading* GpsSensor::update(const VehicleTruth& truth) {
  if (!origin_ || !clock_.due(truth.time)) return nullptr;
  const Eigen::Vector3d stddev(params_.horizontal_stddev, params_.horizontal_stddev,
                               params_.vertical_stddev);
  reading_.time = truth.time;
  reading_.position = origin_->to_global(truth.body.p_WB + stddev.cwiseProduct(random_.normal3()));
  return &reading_;
}

}  // namespace swiftlet
