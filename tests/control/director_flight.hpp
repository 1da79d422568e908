// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "control/flight_director.hpp"
#include "estimation/geometry/so3.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet::test {

inline constexpr Duration kTick = std::chrono::milliseconds(10);

inline Duration seconds(double s) {
  return from_seconds(s);
}

/// For who does not want to wait for the estimate before each flight.
inline FlightDirector::Params settled(FlightDirector::Params params = {}) {
  params.settling_to_arm = 0.0;
  return params;
}

/// A director, a vehicle that does what it is told (within a floor), and a planner that answers.
/// Every tick checks that the reference that is tracked is finite and has no step.
struct DirectorFlight {
  explicit DirectorFlight(const FlightDirector::Params& params = {}) : director(settled(params)) {}

  FlightDirector director;
  Time now{std::chrono::seconds(100)};
  RigidBodyState vehicle;
  double floor_z = 0.0;        // [m]
  double sinking_speed = 0.5;  // while level [m/s]
  bool can_climb = true;
  double ceiling_z = std::numeric_limits<double>::infinity();  // [m]
  // Who is alive.
  bool estimator = true, sonar = true, flight_controller = true;
  bool expect_steps = false;  // the reference may have them

  FlightDirector::Directive last;
  std::vector<std::string> transitions;
  /// Called once a tick with the goal that is set; answers with director.set_plan.
  std::function<void(const PlanGoal&)> planner;
  Trajectory plan;  // that leads_to_goal() gave last

  double altitude() const { return vehicle.p_WB.z() - floor_z; }
  Mode mode() const { return director.status(now).mode; }
  FlightDirector::Status status() const { return director.status(now); }

  void feed() {
    if (estimator) director.set_estimate(now, vehicle, 0.02, 0.01);
    // As the simulated sonar: it reads its minimum from there to the ground.
    if (sonar) director.set_range_down(std::max(0.15, altitude() - 0.05));
    if (flight_controller) director.set_motors_heard(now);
  }

  void tick() {
    now += kTick;
    feed();
    if (planner && last.goal) planner(*last.goal);
    const FlightDirector::Directive directive = director.tick(now);
    if (directive.transition) transitions.push_back(describe(*directive.transition));
    check(directive.setpoint);
    move(directive.setpoint);
    last = directive;
  }

  void fly_for(double duration_s) {
    for (const Time end = now + seconds(duration_s); now < end;) tick();
  }

  /// Ticks until `condition` holds; false where that takes longer than `limit_s`.
  template <class Condition>
  bool tick_until(Condition condition, double limit_s = 30.0) {
    for (const Time end = now + seconds(limit_s); now < end && !condition();) tick();
    return condition();
  }

  /// Ticks until `mode` is flown; false where that takes longer than `limit_s`.
  bool fly_until(Mode mode_, double limit_s) {
    return tick_until([&] { return mode() == mode_; }, limit_s);
  }

  void take_off(double height = 1.2) {
    fly_for(0.05);
    ASSERT_TRUE(director.request(Request::arm(), now).ok());
    ASSERT_TRUE(director.request(Request::takeoff(height), now).ok());
    ASSERT_TRUE(fly_until(Mode::kHover, 10.0));
    ASSERT_NEAR(vehicle.p_WB.z() - floor_z, height, 1e-6);
  }

  /// What a planner does: a smooth way to the goal from the reference a little ahead.
  PlanAnswer leads_to_goal(const PlanGoal& goal, double duration_s = 3.0) {
    const Time begin = now + std::chrono::milliseconds(60);
    FlatReference from = last.setpoint.reference;
    if (!plan.empty() && now < plan.end()) from = plan.evaluate(begin);
    const auto way = minimum_snap(begin, from, {{goal.waypoint.position, from.yaw}}, {duration_s});
    EXPECT_TRUE(way.ok());
    plan = *way;
    return {goal.identity, plan, false, "", ""};
  }

  /// A planner that answers each goal once.
  void answer_once(double duration_s = 3.0) {
    planner = [this, duration_s, answered = Time{}](const PlanGoal& goal) mutable {
      if (std::exchange(answered, goal.identity) == goal.identity) return;
      director.set_plan(leads_to_goal(goal, duration_s));
    };
  }

 private:
  void check(const FlightSetpoint& setpoint) {
    const FlatReference& r = setpoint.reference;
    ASSERT_TRUE(r.position.allFinite() && r.velocity.allFinite() && r.acceleration.allFinite() &&
                r.jerk.allFinite() && r.snap.allFinite() && std::isfinite(r.yaw) &&
                std::isfinite(r.yaw_rate) && std::isfinite(r.yaw_acceleration));
    const bool tracked =
        setpoint.kind == SetpointKind::kTrack && last.setpoint.kind == SetpointKind::kTrack;
    if (!tracked || expect_steps) return;
    // A step of jerk, which is allowed, makes no more of them than this in one tick.
    const FlatReference expected =
        extrapolate(last.setpoint.reference, to_seconds(setpoint.time - last.setpoint.time));
    const std::string when =
        std::string(to_string(mode())) + " at " + std::to_string(to_seconds(now));
    EXPECT_LT((r.position - expected.position).norm(), 1e-4) << "position step, " << when;
    EXPECT_LT((r.velocity - expected.velocity).norm(), 3e-3) << "velocity step, " << when;
    EXPECT_LT((r.acceleration - expected.acceleration).norm(), 0.35) << "acceleration, " << when;
  }

  void move(const FlightSetpoint& setpoint) {
    if (setpoint.kind == SetpointKind::kTrack && can_climb) {
      vehicle.p_WB = setpoint.reference.position;
      vehicle.v_WB_W = setpoint.reference.velocity;
      if (vehicle.p_WB.z() > ceiling_z) {
        vehicle.p_WB.z() = ceiling_z;
        vehicle.v_WB_W.z() = 0.0;
      }
      vehicle.q_WB = from_yaw(setpoint.reference.yaw);
    } else if (setpoint.kind == SetpointKind::kLevel) {
      vehicle.v_WB_W.z() = -sinking_speed;
      vehicle.p_WB += vehicle.v_WB_W * to_seconds(kTick);
    } else {
      vehicle.v_WB_W.setZero();
    }
    if (vehicle.p_WB.z() <= floor_z) {
      vehicle.p_WB.z() = floor_z;
      vehicle.v_WB_W.setZero();
    }
  }
};

}  // namespace swiftlet::test
