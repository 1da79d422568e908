// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of FlightDirector that flies missions: waypoints to goals, and answers to trajectories.
// Exploration uses the latter, too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control/flight_director.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// Farther than anything that is flown to indoors [m].
constexpr double kFarthestWaypoint = 1e4;
/// As of the items of an uploaded mission [m/s].
constexpr double kLeastSpeed = 0.1;
/// Plans beyond these are not for flying: a vehicle of this kind cannot follow them.
constexpr double kFastestPlan = 20.0;        // [m/s]
constexpr double kSharpestPlan = 40.0;       // [m/s^2]
constexpr double kLargestCoefficient = 1e6;  // [m], [rad]
/// A plan may begin with a velocity so much off the one that is flown [m/s].
constexpr double kVelocityGap = 0.3;
/// A plan from the vehicle's own state is so old when it comes [s].
constexpr double kPlanDelay = 0.2;
/// Who flies a plan gets on by so much in so long.
constexpr double kProgressDistance = 0.3;  // [m]
constexpr double kProgressTime = 10.0;     // [s]

bool moderate(const Trajectory& plan) {
  for (const TrajectorySegment& segment : plan.segments()) {
    for (const Polynomial& c : segment.coefficients) {
      if (c.cwiseAbs().maxCoeff() > kLargestCoefficient) return false;
    }
  }
  return plan.max_speed() <= kFastestPlan && plan.max_acceleration() <= kSharpestPlan;
}

}  // namespace

/// Why a mission cannot be flown; "" where it can.
std::string FlightDirector::mission_problem(const std::vector<MissionWaypoint>& waypoints,
                                            std::size_t first_number, double highest) const {
  if (waypoints.empty()) return "it has no waypoints";
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const std::string problem = place_problem(waypoints[i], highest);
    if (!problem.empty()) return fmt::format("waypoint {} is {}", first_number + i, problem);
  }
  return "";
}

std::string FlightDirector::waypoint_problem(const MissionWaypoint& waypoint) const {
  return place_problem(waypoint, params_.modes.max_altitude);
}

/// `highest`: above the take-off point.
std::string FlightDirector::place_problem(const MissionWaypoint& waypoint, double highest) const {
  const Eigen::Vector3d& position = waypoint.position;
  const bool usable = position.allFinite() && position.cwiseAbs().maxCoeff() < kFarthestWaypoint &&
                      std::isfinite(waypoint.yaw.value_or(0.0)) &&
                      waypoint.speed.value_or(kLeastSpeed) >= kLeastSpeed;
  if (!usable) return "not a place that can be flown to";
  // Before the next flight it is here that it will take off.
  const bool rests = machine_.mode() == Mode::kGrounded && estimate_time_;
  const double height = position.z() - (rests ? state_.p_WB : flying_.takeoff_point).z();
  if (height < params_.ground_height) {
    return fmt::format("{:.2f} m above the take-off point; {:.2f} m are the least", height,
                       params_.ground_height);
  }
  if (height > highest) {
    return fmt::format("{:.2f} m above the take-off point; {:.2f} m are the most", height, highest);
  }
  return fence_problem(position);
}

Result<Acceptance> FlightDirector::fly(std::uint64_t id,
                                       const std::vector<MissionWaypoint>& waypoints, Time now,
                                       std::size_t first_number) {
  std::string problem = mission_problem(waypoints, first_number, params_.modes.max_altitude);
  if (problem.empty()) problem = guidance_problem_;
  return begin(Request::navigate(id, problem), waypoints, now, first_number);
}

/// Asks for the mode that flies the waypoints, and begins.
Result<Acceptance> FlightDirector::begin(const Request& request,
                                         const std::vector<MissionWaypoint>& waypoints, Time now,
                                         std::size_t first_number) {
  const Mode before = machine_.mode();
  Result<Acceptance> result = machine_.request(request, situation(now));
  if (!result.ok() || *result != Acceptance::kChanged) return result;
  flying_.last_reason =
      machine_.mode() == before ? "another mission requested" : "mission requested";
  flying_.waypoints = waypoints;
  flying_.waypoint = 0;
  flying_.first_number = first_number;
  flying_.mission_done = false;
  enter(machine_.mode(), now);
  return result;
}

void FlightDirector::set_plan(const PlanAnswer& answer) {
  if (flying_.goal && answer.goal == flying_.goal->identity) answers_.push_back(answer);
}

bool FlightDirector::is_guided() const {
  return machine_.mode() == Mode::kIndoorNavigation || machine_.mode() == Mode::kIndoorExploration;
}

/// What is flown goes on until there is a plan to the new goal.
void FlightDirector::set_goal(const MissionWaypoint& waypoint, Time now) {
  flying_.goal = PlanGoal{now, waypoint};
  if (!flying_.goal->waypoint.yaw) flying_.goal->waypoint.yaw = reference(now).yaw;
  answers_.clear();
  still_at_.reset();
  flying_.waiting_since = flying_.active ? std::max(now, flying_.active->end()) : now;
  flying_.refusal.clear();
}

std::string FlightDirector::goal_name() const {
  if (machine_.returning()) return "the take-off point";
  if (machine_.mode() == Mode::kIndoorNavigation) {
    return fmt::format("waypoint {}", flying_.first_number + flying_.waypoint);
  }
  const Eigen::Vector3d& place = flying_.goal->waypoint.position;
  return fmt::format("({:.2f}, {:.2f})", place.x(), place.y());
}

void FlightDirector::fail_navigation(const std::string& problem) {
  flying_.navigation = Navigation::kFailed;
  flying_.navigation_problem = problem;
}

/// Why a plan cannot be flown; "" where it can.
std::string FlightDirector::plan_problem(const Trajectory& plan, Time now) const {
  if (!moderate(plan)) return "the last plan was too fast to be flown";
  const double lead = to_seconds(plan.start() - now);
  if (lead > params_.plan_timeout) {
    return fmt::format("the last plan was to begin in {:.1f} s", lead);
  }
  // Compared where it takes over from what is flown until then.
  const Time begin = std::max(plan.start(), now);
  FlatReference flown = reference(begin);
  for (const Trajectory& earlier : flying_.coming) {
    if (earlier.start() < plan.start()) flown = earlier.evaluate(begin);
  }
  const FlatReference first = plan.evaluate(begin);
  const std::string fence = plan_leaves_fence(plan);
  if (!fence.empty()) return fence;
  const double gap = (first.position - flown.position).norm();
  const bool continues =
      gap <= params_.plan_gap && (first.velocity - flown.velocity).norm() <= kVelocityGap;
  // A vehicle that was carried away from its reference is planned for from where it is.
  const bool from_vehicle = (first.position - state_.p_WB).norm() <=
                                params_.plan_gap + kPlanDelay * state_.v_WB_W.norm() &&
                            (first.velocity - state_.v_WB_W).norm() <= kVelocityGap;
  if (continues || from_vehicle) return "";
  return fmt::format("the last plan began {:.2f} m and {:.2f} m/s off what is flown", gap,
                     (first.velocity - flown.velocity).norm());
}

void FlightDirector::take_answer(const PlanAnswer& answer, Time now) {
  if (!answer.brake && answer.trajectory.empty()) {
    fail_navigation(fmt::format("{} to {}{}",
                                answer.failure.empty() ? "no usable plan" : answer.failure,
                                goal_name(), answer.reason.empty() ? "" : ": " + answer.reason));
    return;
  }
  if (!answer.brake) flying_.refusal = plan_problem(answer.trajectory, now);
  if (answer.brake || !flying_.refusal.empty()) {
    // The way ahead is not to be flown. At rest already, the wait for a plan just goes on.
    if (flying_.active || !flying_.coming.empty()) {
      stop(reference(now), now);
      flying_.waiting_since = flying_.simple.end();
    }
    return;
  }
  // What was to come after the beginning of this one is outdated.
  while (!flying_.coming.empty() && flying_.coming.back().start() >= answer.trajectory.start()) {
    flying_.coming.pop_back();
  }
  flying_.coming.push_back(answer.trajectory);
}

/// Takes what the planner answered, and the next plan at its time. True once what was planned is
/// flown to its end.
bool FlightDirector::follow_plans(Time now) {
  for (; !answers_.empty() && flying_.navigation == Navigation::kActive; answers_.pop_front()) {
    take_answer(answers_.front(), now);
  }
  while (!flying_.coming.empty() && flying_.coming.front().start() <= now) {
    flying_.active = flying_.coming.front();
    flying_.coming.pop_front();
    flying_.waiting_since.reset();
  }
  if (!flying_.goal || !flying_.coming.empty() || flying_.navigation != Navigation::kActive) {
    return false;
  }
  if (!flying_.waiting_since) return flying_.active && now >= flying_.active->end();
  if (to_seconds(now - *flying_.waiting_since) > params_.plan_timeout) {
    fail_navigation(
        fmt::format("no plan to {} within {:.1f} s; {}", goal_name(), params_.plan_timeout,
                    flying_.refusal.empty() ? "is the planner running?" : flying_.refusal));
  }
  return false;
}

void FlightDirector::follow_mission(Time now) {
  if (flying_.navigation != Navigation::kActive) return;
  if (!guidance_problem_.empty()) return fail_navigation(guidance_problem_);
  if (!flying_.goal && now >= flying_.simple.end()) {
    set_goal(flying_.waypoints[flying_.waypoint], now);
  }
  if (const double left = standstill(now); left > kProgressTime) {
    return fail_navigation(fmt::format(
        "no way was made to {} for {:.0f} s; what holds the vehicle up?", goal_name(), left));
  }
  if (!follow_plans(now)) return;
  const Eigen::Vector3d& goal = flying_.waypoints[flying_.waypoint].position;
  if (arrived(goal)) {
    next_waypoint();
    if (flying_.navigation == Navigation::kActive) {
      set_goal(flying_.waypoints[flying_.waypoint], now);
    }
  } else if (to_seconds(now - flying_.active->end()) > params_.arrival_timeout) {
    fail_navigation(
        fmt::format("{} was missed by {:.2f} m", goal_name(), (goal - state_.p_WB).norm()));
  }
}

/// For how long the vehicle has not moved though a plan is flown [s]: something holds it up that
/// the planner does not see, a ceiling say.
double FlightDirector::standstill(Time now) {
  const bool moved = !still_at_ || (*still_at_ - state_.p_WB).norm() > kProgressDistance;
  if (moved || !flying_.active) {
    still_at_ = state_.p_WB;
    still_since_ = now;
  }
  return to_seconds(now - still_since_);
}

bool FlightDirector::arrived(const Eigen::Vector3d& place) const {
  return (place - state_.p_WB).norm() < params_.arrival_distance &&
         state_.v_WB_W.norm() < params_.arrival_speed;
}

void FlightDirector::next_waypoint() {
  if (flying_.waypoint + 1 < flying_.waypoints.size()) {
    ++flying_.waypoint;
    return;
  }
  flying_.navigation = Navigation::kFinished;
  flying_.mission_done = !machine_.returning();
}

}  // namespace swiftlet
