// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of FlightDirector that explores: it flies where the explorer says, and home at the end.
#include <fmt/format.h>

#include <cmath>

#include "control/flight_director.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// Places nearer to each other are the same [m].
constexpr double kSamePlace = 0.10;

}  // namespace

Result<Acceptance> FlightDirector::explore(Time now) {
  const Mode before = machine_.mode();
  Result<Acceptance> result = machine_.request(Request::explore(guidance_problem_), situation(now));
  if (!result.ok() || machine_.mode() == before) return result;
  flying_.last_reason = "exploration requested";
  flying_.waypoints.clear();
  flying_.waypoint = 0;
  flying_.mission_done = false;
  flying_.cruise_altitude = reference(now).position.z();
  order_.reset();
  order_heard_.reset();
  idle_since_.reset();
  enter(Mode::kIndoorExploration, now);
  return result;
}

void FlightDirector::set_exploration(const ExplorationOrder& order, Time now) {
  if (!order.place.allFinite()) return;  // silence will tell
  order_ = order;
  order_heard_ = now;
}

void FlightDirector::follow_exploration(Time now) {
  if (flying_.navigation != Navigation::kActive) return;
  if (!guidance_problem_.empty()) return fail_navigation(guidance_problem_);
  if (!order_heard_) order_heard_ = now;
  if (to_seconds(now - *order_heard_) > params_.exploration_timeout) {
    return fail_navigation(fmt::format("the explorer was not heard for {:.1f} s; is it running?",
                                       params_.exploration_timeout));
  }
  const bool returns = order_ && order_->kind == ExplorationOrder::Kind::kFinished;
  if (order_ && order_->kind != ExplorationOrder::Kind::kStuck) {
    MissionWaypoint wanted;
    wanted.position.head<2>() = returns ? flying_.takeoff_point.head<2>().eval() : order_->place;
    wanted.position.z() = flying_.cruise_altitude;
    const bool is_new =
        !flying_.goal || (flying_.goal->waypoint.position - wanted.position).norm() > kSamePlace;
    // The brake before the first goal ends at rest; later ones are set in flight.
    if (is_new && (flying_.active || now >= flying_.simple.end())) set_goal(wanted, now);
  }
  const bool flown = follow_plans(now);
  if (flying_.navigation == Navigation::kFailed && !returns && flying_.goal) {
    // No way there: the explorer hears of it, too, and names another place.
    flying_.navigation = Navigation::kActive;
    flying_.refusal = flying_.navigation_problem;
    if (flying_.active || !flying_.coming.empty()) stop(reference(now), now);
    flying_.waiting_since.reset();
  }
  if (flown && returns) {
    flying_.navigation = Navigation::kFinished;
    flying_.mission_done = true;
  }
  const bool is_on_the_way =
      flying_.active || !flying_.coming.empty() || flying_.waiting_since.has_value();
  const bool idle = flown || !is_on_the_way;
  if (!idle || flying_.navigation != Navigation::kActive) {
    idle_since_.reset();
    return;
  }
  if (!idle_since_) idle_since_ = now;
  if (to_seconds(now - *idle_since_) <= params_.exploration_timeout) return;
  if (order_ && order_->kind == ExplorationOrder::Kind::kStuck) {
    fail_navigation(fmt::format("the explorer is stuck: {}", order_->reason));
  } else if (flown) {
    fail_navigation(fmt::format("the explorer asks for {} again and again", goal_name()));
  } else {
    fail_navigation(flying_.refusal.empty() ? "the explorer named no place" : flying_.refusal);
  }
}

}  // namespace swiftlet
