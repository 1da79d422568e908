// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/replanner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

// Two goals that differ by less are the same [m].
constexpr double kSameGoal = 1e-3;

bool is_sound(const RigidBodyState& state) {
  return state.p_WB.allFinite() && state.v_WB_W.allFinite() && state.q_WB.coeffs().allFinite() &&
         state.q_WB.norm() > 1e-6;
}

}  // namespace

/// What is known before planning.
struct Replanner::Situation {
  FlatReference start;  // of a new trajectory
  Time start_time{};
  bool under_way = false;        // on a trajectory, which has not ended
  bool to_goal = false;          // it leads to the goal
  std::string map_problem;       // why there is none
  std::optional<Time> conflict;  // of what is flown with the map
  double speed = 0.0;            // now [m/s]
};

Replanner::Replanner() : Replanner(Params{}) {}
Replanner::Replanner(const Params& params)
    : params_(params), planner_(params.trajectory), map_(params.trajectory.path.cost) {}

void Replanner::set_params(const Params& params) {
  TrajectoryPlanner planner(params.trajectory);
  planner_ = std::move(planner);
  map_ = ClearanceMap(params.trajectory.path.cost);
  params_ = params;
  last_plan_.reset();
  replaces_ = true;
}

void Replanner::reset() {
  goal_.reset();
  last_plan_.reset();
  failing_since_.reset();
  last_failure_ = PlanFailure::kNone;
  last_reason_.clear();
  brakes_ = 0;
  replaces_ = false;
}

bool Replanner::leads_to(const FlightGoal& goal, const Trajectory& trajectory) {
  return !trajectory.empty() &&
         (trajectory.final_reference().position - goal.position).norm() < kSameGoal;
}

Replanner::Situation Replanner::assess(const Input& input) {
  Situation s;
  const bool has_current = input.current != nullptr && !input.current->empty();
  s.start_time = input.now + params_.lead;
  bool on_track = false;
  Time flown = input.now;  // the moment of the current trajectory, which may begin a little later
  if (has_current) {
    flown = std::max(input.now, input.current->start());
    s.start_time = std::max(s.start_time, flown);
    const FlatReference now = input.current->evaluate(flown);
    on_track = (now.position - input.vehicle.p_WB).norm() <= params_.tracking_error_max;
    s.under_way = on_track && input.now < input.current->end();
    s.to_goal = on_track && leads_to(input.goal, *input.current);
  }
  if (on_track) {
    s.start = input.current->evaluate(s.start_time);
    s.speed = input.current->evaluate(flown).velocity.norm();
  } else {
    s.start.position = input.vehicle.p_WB;
    s.start.yaw = yaw_of(input.vehicle.q_WB);
    s.speed = input.vehicle.v_WB_W.norm();
    // A hover that trembles is a start at rest.
    const auto& limits = params_.trajectory.minimum_snap.limits;
    if (s.speed > 0.1 * limits.max_speed) {
      s.start.velocity = input.vehicle.v_WB_W * std::min(1.0, 0.95 * limits.max_speed / s.speed);
    }
  }
  const OccupancyGrid none;
  const Status status = planner_.path_planner().update_map(
      map_, input.grid == nullptr ? none : *input.grid, s.start.position.head<2>());
  if (!status) {
    s.map_problem = status.error().reason;
    return s;
  }
  if (on_track) {
    const auto& path = params_.trajectory.path;
    s.conflict = first_conflict(*input.current, input.now, map_,
                                path.cost.hard_clearance() - params_.blocked_tolerance,
                                path.escape_distance);
  }
  return s;
}

ReplanDecision Replanner::answer_failure(const Input& input, const Situation& situation,
                                         PlanFailure failure, const std::string& reason) {
  ReplanDecision decision;
  decision.failure = failure;
  decision.reason = reason;
  decision.blocked = situation.conflict.has_value();
  // What is flown breaks limits that are new: from rest there is a way within them.
  const bool too_fast = replaces_ && situation.under_way && failure == PlanFailure::kNoTrajectory;
  // It will do, as long as a map says so.
  if (situation.to_goal && !decision.blocked && !too_fast && situation.map_problem.empty()) {
    return decision;
  }
  if (!failing_since_) failing_since_ = input.now;
  const bool given_up = input.now - *failing_since_ >= params_.give_up_after;
  const double braking_s =
      situation.speed / params_.trajectory.minimum_snap.limits.max_acceleration +
      params_.brake_reserve_s;
  const bool near = situation.under_way && decision.blocked &&
                    to_seconds(*situation.conflict - input.now) <= braking_s;
  // From rest there may be a way where none is in flight.
  const bool rest_helps = situation.under_way && failure == PlanFailure::kNoTrajectory;
  if (near || too_fast || (given_up && rest_helps)) {
    decision.action = brakes_++ < params_.max_brakes ? ReplanAction::kBrake : ReplanAction::kFail;
  } else if (given_up) {
    decision.action = ReplanAction::kFail;
  }
  return decision;
}

ReplanDecision Replanner::step(const Input& input) {
  const bool sound =
      is_sound(input.vehicle) && input.goal.position.allFinite() && std::isfinite(input.goal.yaw);
  if (!sound) {
    return answer_failure(input, Situation{}, PlanFailure::kBadInput,
                          "the state of the vehicle or the goal is not finite");
  }
  if (!goal_ || (goal_->position - input.goal.position).norm() >= kSameGoal ||
      goal_->yaw != input.goal.yaw) {
    reset();
    goal_ = input.goal;
  }

  const Situation situation = assess(input);
  const bool due =
      !last_plan_ || input.now - *last_plan_ >= params_.period || input.now < *last_plan_;
  const bool blocked = situation.conflict.has_value();
  const bool needed = blocked || !situation.to_goal || (replaces_ && situation.under_way);
  if (!due && !(blocked && !failing_since_)) {
    if (needed && failing_since_) {
      return answer_failure(input, situation, last_failure_, last_reason_);
    }
    ReplanDecision keep;
    keep.blocked = blocked;
    return keep;
  }

  // What cannot become clearly better need not be planned.
  double current_cost = 0.0;
  if (!needed && !map_.empty()) {
    current_cost = trajectory_cost(*input.current, situation.start_time, map_);
    const double least = planner_.path_planner().least_cost(
        map_, situation.start.position.head<2>(), input.goal.position.head<2>());
    if (least >= (1.0 - params_.improvement) * current_cost) {
      last_plan_ = input.now;
      failing_since_.reset();
      return {};
    }
  }

  last_plan_ = input.now;
  TrajectoryResult result;
  if (map_.empty()) {
    result.failure = input.grid == nullptr || input.grid->empty() ? PlanFailure::kBadInput
                                                                  : PlanFailure::kGoalOutsideMap;
    result.reason = situation.map_problem;
  } else {
    result = planner_.plan(map_, situation.start_time, situation.start, input.goal, params_.seed);
  }
  if (!result.ok()) {
    last_failure_ = result.failure;
    last_reason_ = result.reason;
    return answer_failure(input, situation, result.failure, result.reason);
  }
  failing_since_.reset();
  replaces_ = false;

  ReplanDecision decision;
  decision.blocked = blocked;
  if (!needed && !(trajectory_cost(result.trajectory, situation.start_time, map_) <
                   (1.0 - params_.improvement) * current_cost)) {
    return decision;
  }
  decision.action = ReplanAction::kFollow;
  decision.trajectory = std::move(result.trajectory);
  decision.path = std::move(result.path);
  return decision;
}

}  // namespace swiftlet
