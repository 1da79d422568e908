// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/steady_descent.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

Result<SteadyDescent> SteadyDescent::begin(Time start, FlatReference from, double speed,
                                           const ReferenceLimits& limits) {
  if (!std::isfinite(speed)) return Error{"the speed to sink at is not finite"};
  from.velocity.z() += speed;
  const auto brake = FlightReference::brake(start, from, limits);
  if (!brake.ok()) return brake.error();
  SteadyDescent descent;
  descent.brake_ = *brake;
  descent.speed_ = speed;
  return descent;
}

FlatReference SteadyDescent::at(Time time) const {
  FlatReference reference = brake_.at(time);
  reference.position.z() -= speed_ * std::max(0.0, to_seconds(time - brake_.start()));
  reference.velocity.z() -= speed_;
  return reference;
}

}  // namespace swiftlet
