// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of FlightDirector that watches over a flight: geofence, battery, link, and the way home.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "control/flight_director.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Demand = Situation::Demand;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Farther outside of the fence than this is left, nearer a little overshoot [m].
constexpr double kFenceSlack = 0.30;
/// A guard that was there and has not been heard for so long is not there any more [s].
constexpr double kGuardTimeout = 0.5;
/// Slower is at rest [m/s].
constexpr double kRestSpeed = 0.05;
/// A plan is looked at in steps of [s].
constexpr double kPlanStep = 0.1;

}  // namespace

/// To the edge of the fence from a place inside [m]; none from outside, but back in.
double FlightDirector::way_to_fence(const Eigen::Vector2d& place,
                                    const Eigen::Vector2d& direction) const {
  if (!(params_.fence.radius > 0.0)) return kInfinity;
  const Eigen::Vector2d from_home = place - flying_.takeoff_point.head<2>();
  const double along = from_home.dot(direction);
  const double room = params_.fence.radius * params_.fence.radius - from_home.squaredNorm();
  if (room < 0.0) return along < 0.0 ? kInfinity : 0.0;
  return std::sqrt(along * along + room) - along;
}

/// Why a place is not inside, by more than `slack` [m]; "" where it is.
std::string FlightDirector::fence_problem(const Eigen::Vector3d& place, double slack) const {
  const Geofence& fence = params_.fence;
  const Eigen::Vector3d from_home = place - flying_.takeoff_point;
  const double beyond = from_home.head<2>().norm() - fence.radius;
  if (fence.radius > 0.0 && beyond > slack)
    return fmt::format("{:.1f} m outside of the fence", beyond);
  const double above = from_home.z() - fence.height;
  if (fence.height > 0.0 && above > slack) return fmt::format("{:.1f} m above the fence", above);
  return "";
}

/// Why a plan from inside the fence cannot be flown; "" where it can.
std::string FlightDirector::plan_leaves_fence(const Trajectory& plan) const {
  if (!fence_problem(plan.evaluate(plan.start()).position).empty()) return "";
  const double duration = to_seconds(plan.duration());
  const int steps = static_cast<int>(std::ceil(duration / kPlanStep));
  for (int i = 1; i <= steps; ++i) {
    const Time time = plan.start() + from_seconds(duration * i / steps);
    const std::string problem = fence_problem(plan.evaluate(time).position);
    if (!problem.empty()) return "the last plan led " + problem;
  }
  return "";
}

void FlightDirector::forget_lost_link(Time now) {
  if (link_heard_ && to_seconds(now - *link_heard_) > params_.link_timeout) link_heard_.reset();
}

/// What the policies ask for now: each once, until what it is about is over, so that a pilot who
/// wants something else has the last word.
void FlightDirector::heed_policies(Time now, Situation& situation) {
  const double silence = link_heard_ ? to_seconds(now - *link_heard_) : 0.0;
  if (machine_.mode() == Mode::kGrounded) {
    flying_.demanded = 0;
    forget_lost_link(now);
    return;
  }
  struct Policy {
    bool holds;
    Demand demand;
    std::string reason;
  };
  const double battery = battery_percentage_.value_or(1.0);
  const auto battery_at = [battery](const char* what) {
    return fmt::format("battery {}: {:.0f} %", what, battery * 100.0);
  };
  const std::string fence = fence_problem(state_.p_WB, kFenceSlack);
  const Policy policies[] = {
      {situation.estimate_ok && !fence.empty(), params_.on_fence, fence},
      {battery < params_.low_battery, params_.on_low_battery, battery_at("low")},
      {battery < params_.critical_battery, params_.on_critical_battery, battery_at("critical")},
      {silence > params_.link_timeout, params_.on_link_loss,
       fmt::format("no ground station for {:.1f} s", silence)},
  };
  std::uint32_t bit = 1;
  for (const Policy& policy : policies) {
    const bool had_its_say = (flying_.demanded & bit) != 0;
    const bool speaks = policy.holds && !had_its_say && policy.demand > situation.demand;
    if (speaks) {
      situation.demand = policy.demand;
      situation.demand_reason = policy.reason;
    }
    flying_.demanded = policy.holds ? flying_.demanded | bit : flying_.demanded & ~bit;
    bit <<= 1;
  }
}

/// While the guard flies, the vehicle is to rest where the guard brings it to rest: it gives it
/// back to who asks for that.
void FlightDirector::heed_guard(Time now, Situation& situation) {
  if (guard_heard_ && to_seconds(now - *guard_heard_) > kGuardTimeout) {
    guard_heard_.reset();
    guard_acting_ = false;
    flying_.last_reason = "the guard is silent; nobody watches over this flight";
  }
  const Mode mode = machine_.mode();
  if (!guard_acting_ || mode == Mode::kGrounded || mode == Mode::kLand) return;
  if (situation.demand < Demand::kHover) {
    situation.demand = Demand::kHover;
    situation.demand_reason = "the guard stopped it: " + guard_reason_;
  }
  if (mode != Mode::kHover) return;
  const auto hold = FlightReference::hold(state_.p_WB, yaw_of(state_.q_WB));
  if (hold.ok() && state_.v_WB_W.norm() > kRestSpeed) {
    flying_.active.reset();
    flying_.coming.clear();
    flying_.simple = hold->trajectory();
  }
}

void FlightDirector::set_guidance_problem(const std::string& problem) {
  // Who flies without plans goes on, and is told.
  const bool is_new = !problem.empty() && guidance_problem_.empty();
  if (is_new && machine_.mode() != Mode::kGrounded) flying_.last_reason = problem;
  guidance_problem_ = problem;
}

void FlightDirector::set_guard(bool acting, const std::string& reason, Time time) {
  guard_acting_ = acting;
  guard_reason_ = reason;
  guard_heard_ = time;
}

/// Over the take-off point at the height that is flown, and down there.
Result<Acceptance> FlightDirector::go_back(Time now) {
  const bool straight = machine_.mode() == Mode::kGpsGuidance;
  const Result<Acceptance> result = machine_.request(
      Request::go_back(straight ? std::string() : guidance_problem_), situation(now));
  if (!result.ok() || *result != Acceptance::kChanged) return result;
  flying_.last_reason = "return requested";
  enter(machine_.mode(), now);
  return result;
}

}  // namespace swiftlet
