// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "planner/path/replanner.hpp"
#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

struct Query {
  Eigen::Vector2d start, goal;
};

/// Pairs of places in the office that the vehicle can stand at.
std::vector<Query> queries(const OccupancyGrid& grid, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(0.5, 14.7), y(0.5, 9.7);
  const auto map = ClearanceMap::make(grid, {});
  const auto place = [&] {
    Eigen::Vector2d p(x(random), y(random));
    while (map->clearance_at(p) < 0.4) p = {x(random), y(random)};
    return p;
  };
  std::vector<Query> result;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d start = place();
    result.push_back({start, place()});
  }
  return result;
}

/// Runs `plan(query)` over all queries and reports the distribution of its wall time.
template <class Plan>
void run(benchmark::State& state, Plan plan) {
  const OccupancyGrid grid = test::office();
  const std::vector<Query> all = queries(grid, 500);
  std::vector<double> times_ms;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    plan(grid, all[i++ % all.size()]);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    times_ms.push_back(took.count());
  }
  std::sort(times_ms.begin(), times_ms.end());
  state.counters["p50_ms"] = times_ms[times_ms.size() / 2];
  state.counters["p99_ms"] = times_ms[times_ms.size() * 99 / 100];
}

/// From the grid to the path, goal: p99 at most 50 ms.
void plan_path(benchmark::State& state) {
  const PathPlanner planner;
  run(state, [&](const OccupancyGrid& grid, const Query& query) {
    benchmark::DoNotOptimize(planner.plan(grid, query.start, query.goal, 1));
  });
}
BENCHMARK(plan_path)->Name("planner/office_path")->Unit(benchmark::kMillisecond)->Iterations(1000);

/// The steps of the policy on the way to a goal far outside of what is known, one room of the
/// office, for 50 s. A component is not heard while one lasts; goal: p99 at most 50 ms.
void plan_far(benchmark::State& state) {
  OccupancyGrid grid = test::office();
  test::paint(grid, 5.2, -1.0, 16.0, 11.0, CellState::kUnknown);
  std::vector<double> times_ms;
  Replanner replanner;
  Trajectory current;
  Replanner::Input input;
  input.current = &current;
  input.grid = &grid;
  input.vehicle.p_WB = {2.5, 2.0, 1.0};
  input.goal.position = {static_cast<double>(state.range(0)), 36.0, 1.0};
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const ReplanDecision decision = replanner.step(input);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    times_ms.push_back(took.count());
    if (decision.action == ReplanAction::kFollow) current = decision.trajectory;
    if (current.empty()) return state.SkipWithError("no way was found");
    input.now += std::chrono::milliseconds(50);
    input.vehicle.p_WB = current.evaluate(input.now).position;
  }
  std::sort(times_ms.begin(), times_ms.end());
  state.counters["p50_ms"] = times_ms[times_ms.size() / 2];
  state.counters["p99_ms"] = times_ms[times_ms.size() * 99 / 100];
  state.counters["worst_ms"] = times_ms.back();
}
BENCHMARK(plan_far)
    ->Name("planner/far_goal")
    ->Arg(40)
    ->Arg(250)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000);

/// From the grid to the checked trajectory, goal: p99 at most 50 ms.
void plan_trajectory(benchmark::State& state) {
  const TrajectoryPlanner planner;
  run(state, [&](const OccupancyGrid& grid, const Query& query) {
    FlatReference start;
    start.position << query.start, 1.0;
    FlightGoal goal;
    goal.position << query.goal, 1.0;
    benchmark::DoNotOptimize(planner.plan(grid, Time{}, start, goal, 1));
  });
}
BENCHMARK(plan_trajectory)
    ->Name("planner/office_trajectory")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000);

}  // namespace
}  // namespace swiftlet
