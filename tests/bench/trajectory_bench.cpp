// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Goals: 10 waypoints solved within 1 ms, 100 within 10 ms, growing linearly.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "planner/trajectory/durations.hpp"
#include "planner/trajectory/minimum_snap_planner.hpp"

namespace swiftlet {
namespace {

/// A way that winds through space, of legs between 1 and 2 m.
std::vector<Waypoint> winding_way(std::int64_t n) {
  std::vector<Waypoint> waypoints(static_cast<std::size_t>(n));
  Eigen::Vector3d position(0.0, 0.0, 1.0);
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto k = static_cast<double>(i);
    const double length = 1.5 + 0.5 * std::sin(2.3 * k), course = 1.2 * std::sin(0.7 * k);
    position += Eigen::Vector3d(length * std::cos(course), length * std::sin(course),
                                0.2 * std::sin(1.9 * k));
    waypoints[i].position = position;
    waypoints[i].yaw = course;
  }
  return waypoints;
}

FlatReference start() {
  FlatReference reference;
  reference.position.z() = 1.0;
  return reference;
}

TrajectoryLimits all_limits() {
  TrajectoryLimits limits;
  limits.max_thrust_per_mass = 12.0;
  limits.min_thrust_per_mass = 8.0;
  limits.max_body_rate = 1.5;
  limits.max_yaw_rate = 1.0;
  return limits;
}

/// The minimum for given durations.
void solve(benchmark::State& state) {
  const auto waypoints = winding_way(state.range(0));
  const auto durations = trapezoid_durations(start(), waypoints, SpeedProfile());
  for (auto _ : state) {
    benchmark::DoNotOptimize(minimum_snap(Time{}, start(), waypoints, durations));
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(solve)
    ->Name("trajectory/minimum_snap")
    ->Unit(benchmark::kMicrosecond)
    ->Arg(10)
    ->Arg(30)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Complexity(benchmark::oN);

void plan_within(benchmark::State& state, const MinimumSnapPlanner::Params& params) {
  const auto waypoints = winding_way(state.range(0));
  const MinimumSnapPlanner planner(params);
  bool all_planned = true;
  for (auto _ : state) {
    const auto trajectory = planner.plan(Time{}, start(), waypoints);
    all_planned = all_planned && trajectory.ok();
    benchmark::DoNotOptimize(trajectory);
  }
  if (!all_planned) state.SkipWithError("no trajectory within the limits");
}

/// Durations such that limits of speed and acceleration hold.
void plan(benchmark::State& state) {
  plan_within(state, {});
}
BENCHMARK(plan)->Name("trajectory/plan")->Unit(benchmark::kMillisecond)->Arg(10)->Arg(100);

/// The same with every limit there is.
void plan_all_limits(benchmark::State& state) {
  MinimumSnapPlanner::Params params;
  params.limits = all_limits();
  plan_within(state, params);
}
BENCHMARK(plan_all_limits)
    ->Name("trajectory/plan_all_limits")
    ->Unit(benchmark::kMillisecond)
    ->Arg(10)
    ->Arg(100);

/// Durations of least snap, and every limit.
void plan_least_snap(benchmark::State& state) {
  MinimumSnapPlanner::Params params;
  params.limits = all_limits();
  params.timing = Timing::kLeastSnap;
  plan_within(state, params);
}
BENCHMARK(plan_least_snap)
    ->Name("trajectory/plan_least_snap")
    ->Unit(benchmark::kMillisecond)
    ->Arg(10)
    ->Arg(100);

/// The guaranteed extrema of one piece: speed and acceleration, then all of them.
void bound(benchmark::State& state) {
  const auto waypoints = winding_way(10);
  const auto trajectory = *MinimumSnapPlanner().plan(Time{}, start(), waypoints);
  std::size_t i = 0;
  for (auto _ : state) {
    const TrajectorySegment& segment = trajectory.segments()[i++ % 10];
    if (state.range(0) == 0) {
      benchmark::DoNotOptimize(max_derivative_norm(segment, 1));
      benchmark::DoNotOptimize(max_derivative_norm(segment, 2));
    } else {
      benchmark::DoNotOptimize(extrema(segment));
    }
  }
}
BENCHMARK(bound)
    ->Name("trajectory/extrema")
    ->Unit(benchmark::kMicrosecond)
    ->ArgName("all")
    ->Arg(0)
    ->Arg(1);

}  // namespace
}  // namespace swiftlet
