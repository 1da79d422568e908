// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/claw_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace swiftlet {
namespace {

/// Pulses that hobby servos understand [us].
constexpr double kShortestPulse = 400.0;
constexpr double kLongestPulse = 2600.0;
/// A tick that comes later moves the pulse no further than this [s].
constexpr double kLongestTick = 0.1;

void demand(bool holds, const char* reason) {
  if (!holds) throw std::invalid_argument(reason);
}

void check(const ClawController::Params& p) {
  for (const double pulse : {p.pulse_open_us, p.pulse_closed_us}) {
    demand(pulse >= kShortestPulse && pulse <= kLongestPulse,
           "pulses must be from 400 to 2600 us long");
  }
  demand(p.tolerance_us > 0.0, "'tolerance_us' must be positive");
  demand(std::abs(p.pulse_closed_us - p.pulse_open_us) > 4.0 * p.tolerance_us,
         "'pulse_open_us' and 'pulse_closed_us' must be more than four times 'tolerance_us' apart");
  demand(p.travel_time > 0.0 && p.patience > 0.0 && p.feedback_timeout > 0.0 && p.stall_time > 0.0,
         "times must be positive");
  demand(p.holding_current > 0.0 && p.holding_current < p.stall_current &&
             p.stall_current < p.current_limit,
         "'holding_current' must be less than 'stall_current', and that less than "
         "'current_limit'");
  demand(p.holding_gain_us > 0.0, "'holding_gain_us' must be positive");
}

}  // namespace

ClawController::ClawController(const Params& params) : params_(params) {
  check(params);
}

void ClawController::set_feedback(double pulse_us, double current, Time now) {
  if (std::isfinite(pulse_us) && std::isfinite(current)) {
    feedback_ = Feedback{pulse_us, std::abs(current), now};
  }
}

void ClawController::command(bool open, Time now) {
  if (open_ == open) return;
  open_ = open;
  begin(now);
}

void ClawController::begin(Time now) {
  begun_ = now;
  blocked_since_.reset();
  silent_ = false;
  reason_.clear();
  state_ = *open_ ? State::kOpening : State::kClosing;
}

bool ClawController::hears(Time now) const {
  return feedback_ && to_seconds(now - feedback_->heard) <= params_.feedback_timeout;
}

std::optional<double> ClawController::opening(Time now) const {
  if (!hears(now)) return std::nullopt;
  const double travel = params_.pulse_open_us - params_.pulse_closed_us;
  const double share = (feedback_->pulse_us - params_.pulse_closed_us) / travel;
  return share > 0.0 ? std::min(share, 1.0) : 0.0;
}

std::optional<double> ClawController::current(Time now) const {
  return hears(now) ? std::optional(feedback_->current) : std::nullopt;
}

bool ClawController::at(double pulse_us, double tolerance_us) const {
  return std::abs(feedback_->pulse_us - pulse_us) <= tolerance_us;
}

/// Whether the current has said so for long enough.
bool ClawController::blocked(Time now) {
  if (feedback_->current < params_.stall_current) {
    blocked_since_.reset();
    return false;
  }
  if (!blocked_since_) blocked_since_ = now;
  return to_seconds(now - *blocked_since_) >= params_.stall_time;
}

double ClawController::within(double pulse_us) const {
  const auto [low, high] = std::minmax(params_.pulse_open_us, params_.pulse_closed_us);
  return std::clamp(pulse_us, low, high);
}

void ClawController::move(double to_us, double step_us) {
  *pulse_us_ += std::clamp(within(to_us) - *pulse_us_, -step_us, step_us);
}

void ClawController::fail(const std::string& reason) {
  state_ = State::kFault;
  reason_ = reason;
}

std::optional<double> ClawController::tick(Time now) {
  const double dt = last_tick_ ? std::clamp(to_seconds(now - *last_tick_), 0.0, kLongestTick) : 0.0;
  last_tick_ = now;
  if (!open_) return std::nullopt;
  if (!hears(now)) {
    silent_ = true;
    fail("the servo says nothing: is it powered and connected?");
    return pulse_us_;
  }
  if (silent_) begin(now);
  // From where it stands: the first pulse moves nothing.
  if (!pulse_us_) pulse_us_ = within(feedback_->pulse_us);
  const double step_us =
      std::abs(params_.pulse_closed_us - params_.pulse_open_us) / params_.travel_time * dt;
  if (feedback_->current > params_.current_limit || state_ == State::kFault) {
    // It gives way, and pushes no further against what blocks it.
    move(feedback_->pulse_us, step_us);
  } else if (state_ == State::kHolding) {
    hold(dt, step_us);
  } else if (feedback_->current < params_.stall_current) {
    move(end(*open_), step_us);
  }
  advance(now);
  return pulse_us_;
}

/// Pushes with the current that holds. Never pulls: what is held may push the jaws open.
void ClawController::hold(double dt, double step_us) {
  const double correction =
      params_.holding_gain_us * (params_.holding_current - feedback_->current) * dt;
  const double closing = params_.pulse_closed_us > params_.pulse_open_us ? 1.0 : -1.0;
  const auto [low, high] = std::minmax(feedback_->pulse_us, params_.pulse_closed_us);
  move(std::clamp(*pulse_us_ + closing * correction, low, high), step_us);
}

void ClawController::advance(Time now) {
  switch (state_) {
    case State::kOpening:
    case State::kClosing:
      return reach(*open_, now);
    case State::kOpen:
    case State::kClosed:
      // Somebody moved the jaws.
      if (!at(end(*open_), 2.0 * params_.tolerance_us)) begin(now);
      return;
    case State::kHolding:
      if (at(params_.pulse_closed_us, params_.tolerance_us)) state_ = State::kClosed;
      return;
    case State::kFault:
    case State::kUnknown:
      return;
  }
}

void ClawController::reach(bool open, Time now) {
  if (at(end(open), params_.tolerance_us)) {
    state_ = open ? State::kOpen : State::kClosed;
    return;
  }
  const double percent = 100.0 * *opening(now);
  if (blocked(now)) {
    if (open) return fail(fmt::format("blocked while opening, at {:.0f} %", percent));
    state_ = State::kHolding;
    return;
  }
  const double time = params_.travel_time + params_.stall_time + params_.patience;
  if (to_seconds(now - begun_) <= time) return;
  // Something thin keeps it from its end: the pulse is there and pushes a little.
  if (!open && feedback_->current > 0.5 * params_.holding_current) {
    state_ = State::kHolding;
  } else {
    fail(fmt::format("does not {} within {:.1f} s, stands at {:.0f} %", open ? "open" : "close",
                     time, percent));
  }
}

}  // namespace swiftlet
