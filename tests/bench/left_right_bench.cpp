// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// PathPlanner beside the rule of the multi-sensor MAV, on the same problems, each of which has a
// way (Dijkstra over the cells says so).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/bench/left_right_rule.hpp"
#include "tests/planner/exploration/random_house.hpp"
#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr int kProblems = 300;  // of a kind

struct Problem {
  OccupancyGrid grid;
  ClearanceMap map;
  Vector2d start, goal;
};

OccupancyGrid random_house(std::mt19937& random) {
  const test::RandomHouse house(static_cast<unsigned>(random()));
  OccupancyGrid grid({}, {-0.15, -0.15}, 286, 206);
  test::paint(grid, 0.0, 0.0, test::RandomHouse::kWidth, test::RandomHouse::kHeight,
              CellState::kFree);
  for (const auto& box : house.boxes) {
    test::paint(grid, box.lower.x(), box.lower.y(), box.upper.x(), box.upper.y(),
                CellState::kOccupied);
  }
  return grid;
}
OccupancyGrid office(std::mt19937& /*random*/) {
  return test::office();
}
OccupancyGrid random_field(std::mt19937& random) {
  return test::random_field(random, 8.0);
}

/// Two places at least 2 m apart, with a way from one to the other.
template <class MakeGrid>
Problem draw_problem(MakeGrid make_grid, std::mt19937& random) {
  const PathPlanner planner;
  for (;;) {
    Problem problem;
    problem.grid = make_grid(random);
    const Vector2d size =
        problem.grid.resolution() * Vector2d(problem.grid.width(), problem.grid.height());
    std::uniform_real_distribution<double> x(0.0, size.x()), y(0.0, size.y());
    problem.start = problem.grid.origin() + Vector2d(x(random), y(random));
    problem.goal = problem.grid.origin() + Vector2d(x(random), y(random));
    if ((problem.goal - problem.start).norm() < 2.0) continue;
    problem.map = *planner.make_map(problem.grid, problem.start);
    const ClearanceMap& map = problem.map;
    if (map.clearance_at(problem.start) < 0.4 || map.clearance_at(problem.goal) < 0.4) continue;
    const double way = test::dijkstra_length(
        map, map.cell_of(problem.start), map.cell_of(problem.goal), map.cost().hard_clearance());
    if (std::isfinite(way)) return problem;
  }
}

bool meets(const Vector2d& a, const Vector2d& b, const Vector2d& low, const Vector2d& high) {
  double from = 0.0, to = 1.0;
  for (int i = 0; i < 2; ++i) {
    const double along = b[i] - a[i];
    if (along == 0.0) {
      if (a[i] < low[i] || a[i] > high[i]) return false;
      continue;
    }
    const double s = (low[i] - a[i]) / along, t = (high[i] - a[i]) / along;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  return from <= to;
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

/// From a segment to a box: where they do not meet, an end of the one or a corner of the other is
/// nearest.
double distance(const Vector2d& a, const Vector2d& b, const Vector2d& low, const Vector2d& high) {
  if (meets(a, b, low, high)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const Vector2d& end : {a, b}) {
    least = std::min(least, (end - end.cwiseMax(low).cwiseMin(high)).norm());
  }
  for (const double x : {low.x(), high.x()}) {
    for (const double y : {low.y(), high.y()}) {
      least = std::min(least, distance_to_segment({x, y}, a, b));
    }
  }
  return least;
}

/// From the path to the nearest occupied cell [m], exactly: every leg against every cell, without
/// the distance field that both planners look at.
double least_clearance(const OccupancyGrid& grid, const Path& path) {
  const Vector2d half = Vector2d::Constant(0.5 * grid.resolution());
  double least = std::numeric_limits<double>::infinity();
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid.state({x, y}) != CellState::kOccupied) continue;
      const Vector2d center = grid.center_of({x, y});
      for (std::size_t i = 1; i < path.points.size(); ++i) {
        least = std::min(
            least, distance(path.points[i - 1], path.points[i], center - half, center + half));
      }
    }
  }
  return least;
}

/// What one planner did on all problems of a kind.
struct Tally {
  int solved = 0, touching = 0;
  double relative_length = 0.0;  // sum over the problems that both solve, as is the next
  double clearance = 0.0;        // [m]
  std::vector<double> times_ms;  // of the processor, since others may work beside
};

struct Answer {
  std::optional<Path> path;
  double clearance = 0.0;  // [m]
};

template <class Plan>
Answer ask(const Problem& problem, Tally& tally, Plan plan) {
  const std::clock_t begin = std::clock();
  Answer answer{plan()};
  tally.times_ms.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  if (!answer.path) return answer;
  answer.clearance = least_clearance(problem.grid, *answer.path);
  ++tally.solved;
  tally.touching += answer.clearance < problem.map.cost().radius;
  return answer;
}

void report(benchmark::State& state, const std::string& name, Tally& tally, int both) {
  std::sort(tally.times_ms.begin(), tally.times_ms.end());
  const auto count = static_cast<double>(tally.times_ms.size());
  state.counters[name + "_solved_percent"] = 100.0 * tally.solved / count;
  state.counters[name + "_touching_percent"] = 100.0 * tally.touching / std::max(1, tally.solved);
  state.counters[name + "_relative_length"] = tally.relative_length / std::max(1, both);
  state.counters[name + "_clearance_m"] = tally.clearance / std::max(1, both);
  state.counters[name + "_p50_ms"] = tally.times_ms[tally.times_ms.size() / 2];
  state.counters[name + "_p99_ms"] = tally.times_ms[tally.times_ms.size() * 99 / 100];
}

/// An iteration is a problem; its time is that of making it, of both plans and of
/// the checks.
template <class MakeGrid>
void compare(benchmark::State& state, MakeGrid make_grid) {
  std::mt19937 random(1);
  const PathPlanner planner;
  Tally ours, rule;
  int both = 0, straight = 0;
  for (auto _ : state) {
    const Problem problem = draw_problem(make_grid, random);
    const Vector2d &start = problem.start, &goal = problem.goal;
    const Answer a = ask(problem, ours, [&]() -> std::optional<Path> {
      PathResult result = planner.plan(problem.map, start, goal, 1);
      if (!result.ok()) return std::nullopt;
      return result.path;
    });
    const Answer b =
        ask(problem, rule, [&] { return bench::left_right_path(problem.map, start, goal); });
    if (!a.path || !b.path) continue;
    ++both;
    straight += b.path->points.size() == 2;
    const double shorter = std::min(a.path->length, b.path->length);
    ours.relative_length += a.path->length / shorter;
    rule.relative_length += b.path->length / shorter;
    ours.clearance += a.clearance;
    rule.clearance += b.clearance;
  }
  report(state, "planner", ours, both);
  report(state, "rule", rule, both);
  state.counters["straight_percent"] = 100.0 * straight / static_cast<double>(state.iterations());
}

BENCHMARK_CAPTURE(compare, houses, random_house)
    ->Name("planner/beside_left_right_rule/houses")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kProblems);
BENCHMARK_CAPTURE(compare, office, office)
    ->Name("planner/beside_left_right_rule/office")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kProblems);
BENCHMARK_CAPTURE(compare, fields, random_field)
    ->Name("planner/beside_left_right_rule/fields")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kProblems);

}  // namespace
}  // namespace swiftlet
