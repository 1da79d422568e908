// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "estimation/ukf/delayed_ukf.hpp"

namespace swiftlet {

struct EstimatorParams {
  DelayedUkf::Params filter;
  int odometry_every = 4;  ///< IMU samples: 250 Hz of a 1 kHz IMU
};

/// The section `estimator`. Throws ConfigError where a value cannot be used.
EstimatorParams read_estimator_params(const Config& config);

}  // namespace swiftlet
