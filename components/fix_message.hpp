// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimation/geodesy/global_fix.hpp"
#include "sensor_msgs.h"

namespace swiftlet {

/// Of a satellite fix that does not say how good it is [m].
inline constexpr double kUnknownFixSigma = 5.0;

/// Nothing where the receiver has no fix.
inline std::optional<GlobalFix> from_msg(const sensor_msgs::msg::NavSatFix& fix) {
  using namespace sensor_msgs::msg;
  if (fix.status().status() == NavSatStatus_Constants::STATUS_NO_FIX) return std::nullopt;
  const bool says = fix.position_covariance_type() != NavSatFix_Constants::COVARIANCE_TYPE_UNKNOWN;
  const double variance = std::max(fix.position_covariance()[0], fix.position_covariance()[4]);
  return GlobalFix{{fix.latitude(), fix.longitude(), fix.altitude()},
                   says ? std::sqrt(variance) : kUnknownFixSigma};
}

}  // namespace swiftlet
