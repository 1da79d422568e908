// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/claw_servo.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

ClawServo::ClawServo(const Params& params)
    : params_(params),
      opening_(params.start_opening),
      pulse_us_(pulse_of(params.start_opening)),
      current_(params.idle_current) {}

void ClawServo::set_pulse(double pulse_us) {
  if (std::isfinite(pulse_us)) pulse_us_ = pulse_us;
}

void ClawServo::step(Duration duration) {
  const double dt = to_seconds(duration);
  const double travel_us = params_.pulse_open_us - params_.pulse_closed_us;
  const double asked = (pulse_us_ - params_.pulse_closed_us) / travel_us;
  const double fastest = params_.max_speed_us / std::abs(travel_us) * dt;
  const double lagged = (asked - opening_) * (1.0 - std::exp(-dt / params_.time_constant));
  const double wanted = opening_ + std::clamp(lagged, -fastest, fastest);
  const double narrowest = params_.object ? std::min(params_.object_opening, opening_) : 0.0;
  const double widest = params_.jammed ? params_.start_opening : 1.0;
  const double reached = std::clamp(wanted, narrowest, widest);
  const double load = reached == wanted
                          ? params_.moving_current * std::abs(reached - opening_) / fastest
                          : params_.stall_gain * std::abs((asked - reached) * travel_us);
  current_ = std::min(params_.idle_current + load, params_.stall_current);
  opening_ = reached;
}

}  // namespace swiftlet
