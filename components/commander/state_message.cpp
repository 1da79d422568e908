// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/state_message.hpp"

#include <algorithm>
#include <tuple>

#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"
#include "components/mode_message.hpp"
#include "components/planner/trajectory_message.hpp"

namespace swiftlet {
namespace {

using Navigation = Situation::Navigation;

/// What changes when anything that is decided changes.
auto key(const FlightDirector::State& s) {
  const auto& m = s.machine;
  // By hand, what is flown is made anew each tick; the commander tells it at its own pace.
  const bool by_hand = m.mode == Mode::kManual || m.mode == Mode::kAssistedManual;
  return std::make_tuple(m.mode, m.armed, m.blind, m.takeoff_altitude, m.mission, m.returning,
                         s.demanded, by_hand ? Time{} : s.simple.start(),
                         s.active ? s.active->start() : Time{}, s.coming.size(),
                         s.coming.empty() ? Time{} : s.coming.back().start(), s.blind, s.waypoint,
                         s.goal ? s.goal->identity : Time{}, s.waiting_since, s.refusal,
                         s.mission_done, s.navigation, s.last_reason);
}

std::uint8_t to_msg(Navigation navigation) {
  return static_cast<std::uint8_t>(navigation);
}

Navigation navigation_of(std::uint8_t message) {
  for (const Navigation navigation :
       {Navigation::kActive, Navigation::kFinished, Navigation::kFailed}) {
    if (to_msg(navigation) == message) return navigation;
  }
  return Navigation::kInactive;
}

}  // namespace

bool differs(const FlightDirector::State& a, const FlightDirector::State& b) {
  return key(a) != key(b);
}

swiftlet_msgs::msg::CommanderState to_msg(const FlightDirector::State& state) {
  const Time goal = state.goal ? state.goal->identity : Time{};
  swiftlet_msgs::msg::CommanderState message;
  message.mode(to_msg(state.machine.mode));
  message.armed(state.machine.armed);
  message.blind(state.blind);
  message.takeoff_altitude(state.machine.takeoff_altitude);
  message.takeoff_point(to_point(state.takeoff_point));
  message.simple(to_msg(state.simple, goal));
  if (state.active) message.active(to_msg(*state.active, goal));
  for (const Trajectory& plan : state.coming) message.coming().push_back(to_msg(plan, goal));
  message.mission(make_mission(Time{}, "", state.waypoints));
  message.mission_identity(state.machine.mission);
  message.waypoint(static_cast<std::uint32_t>(state.waypoint));
  message.first_number(static_cast<std::uint32_t>(state.first_number));
  message.has_goal(state.goal.has_value());
  if (state.goal) {
    message.goal_stamp(to_msg(goal));
    message.goal(make_mission(Time{}, "", {state.goal->waypoint}).waypoints().front());
  }
  message.waiting(state.waiting_since.has_value());
  message.waiting_since(to_msg(state.waiting_since.value_or(Time{})));
  message.refusal(state.refusal);
  message.mission_done(state.mission_done);
  message.cruise_altitude(state.cruise_altitude);
  message.returning(state.machine.returning);
  message.demanded(state.demanded);
  message.navigation(to_msg(state.navigation));
  message.navigation_problem(state.navigation_problem);
  message.reason(state.last_reason);
  return message;
}

FlightDirector::State from_msg(const swiftlet_msgs::msg::CommanderState& message) {
  FlightDirector::State state;
  for (const Mode mode : kModes) {
    if (to_msg(mode) == message.mode()) state.machine.mode = mode;
  }
  state.machine.armed = message.armed();
  state.machine.blind = message.blind();
  state.machine.takeoff_altitude = message.takeoff_altitude();
  state.machine.mission = message.mission_identity();
  state.takeoff_point = from_msg(message.takeoff_point());
  state.simple = from_msg(message.simple());
  const Trajectory active = from_msg(message.active());
  if (!active.empty()) state.active = active;
  for (const auto& plan : message.coming()) state.coming.push_back(from_msg(plan));
  state.blind = message.blind();
  state.waypoints = waypoints_of(message.mission());
  state.waypoint = message.waypoint();
  state.first_number = message.first_number();
  if (message.has_goal()) {
    swiftlet_msgs::msg::Mission goal;
    goal.waypoints().push_back(message.goal());
    state.goal = PlanGoal{from_msg(message.goal_stamp()), waypoints_of(goal).front()};
  }
  if (message.waiting()) state.waiting_since = from_msg(message.waiting_since());
  state.refusal = message.refusal();
  state.mission_done = message.mission_done();
  state.cruise_altitude = message.cruise_altitude();
  state.machine.returning = message.returning();
  state.demanded = message.demanded();
  state.navigation = navigation_of(message.navigation());
  state.navigation_problem = message.navigation_problem();
  state.last_reason = message.reason();
  return state;
}

swiftlet_msgs::msg::VehicleStatus to_msg(const FlightDirector::Status& status) {
  swiftlet_msgs::msg::VehicleStatus message;
  message.mode(to_msg(status.mode));
  message.armed(status.armed);
  message.ready(status.ready);
  message.reason(status.reason);
  message.height(status.height);
  message.waypoint(static_cast<std::uint32_t>(status.waypoint));
  message.waypoint_count(static_cast<std::uint32_t>(status.waypoint_count));
  message.mission_done(status.mission_done);
  message.takeoff_point(to_point(status.home));
  return message;
}

}  // namespace swiftlet
