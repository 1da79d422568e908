// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/abandoned_flight.hpp"

#include <cmath>
#include <stdexcept>

namespace swiftlet {

void GroundSonar::set_range(double range) {
  if (std::isnan(range)) return;
  range_ = range;
  is_new_ = true;
}

void GroundSonar::step(Time now) {
  if (is_new_) heard_at_ = now;
  is_new_ = false;
  heard_ = heard_at_ && to_seconds(now - *heard_at_) <= params_.timeout;
  const bool near = heard_ && *range_ < params_.ground_range;
  if (!near) near_since_.reset();
  if (near && !near_since_) near_since_ = now;
  near_for_.reset();
  if (near) near_for_ = to_seconds(now - *near_since_);
}

AbandonedFlight::AbandonedFlight(const Params& params) {
  set_params(params);
}

void AbandonedFlight::set_params(const Params& params) {
  const auto within = [](double v, double most) { return v > 0.0 && v <= most; };
  const bool fine =
      FlightReference::move({}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.0, params.braking).ok() &&
      within(params.timeout, 60.0) && within(params.landing_speed, 5.0) &&
      within(params.resistance, params.resistance_alone) &&
      within(params.resistance_alone, params.resistance_against) &&
      within(params.resistance_against, 10.0);
  if (!fine) {
    throw std::invalid_argument(
        "abandoned flight: limits of the brake must be from 0.001 to 10000, timeout above 0 and at "
        "most 60 s, landing_speed at most 5 m/s, and resistance <= resistance_alone <= "
        "resistance_against above 0 and at most 10 m");
  }
  params_ = params;
}

Status AbandonedFlight::begin(Time since, Time now, const FlatReference& flown) {
  const auto brake = FlightReference::brake(now, flown, params_.braking);
  if (!brake.ok()) return brake.error();
  brake_ = *brake;
  since_ = since;
  landing_ = false;
  return {};
}

FlatReference AbandonedFlight::reference(Time now) {
  if (!landing_ && to_seconds(now - since_) >= params_.timeout) {
    const auto descent =
        SteadyDescent::begin(now, flown(now), params_.landing_speed, params_.braking);
    if (descent.ok()) descent_ = *descent;
    landing_ = descent.ok();
  }
  return flown(now);
}

bool AbandonedFlight::landed(Time now, double height, const GroundSonar& sonar) const {
  if (!landing_) return false;
  const double resistance = height - flown(now).position.z();
  if (sonar.near_ground_for()) return resistance >= params_.resistance;
  return resistance >= (sonar.heard() ? params_.resistance_against : params_.resistance_alone);
}

}  // namespace swiftlet
