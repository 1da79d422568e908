// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "perception/distance_field.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {
namespace {

/// 1000 beams in a hall of 15 x 10 m, from 0.5 m beside its middle.
LaserScan hall_scan() {
  LaserScan scan;
  scan.angle_min = -3.14159265358979323846;
  scan.angle_increment = -2 * scan.angle_min / 1000;
  scan.range_min = 0.1;
  scan.range_max = 12.0;
  for (int i = 0; i < 1000; ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = c > 0 ? 7.0 / c : c < 0 ? -8.0 / c : 1e9;
    const double y = s > 0 ? 5.0 / s : s < 0 ? -5.0 / s : 1e9;
    scan.ranges.push_back(static_cast<float>(std::min(x, y)));
  }
  return scan;
}

/// Goal: at most 1 ms.
void occupancy_update(benchmark::State& state) {
  const LaserScan scan = hall_scan();
  OccupancyGrid grid;
  double yaw = 0.0;
  for (auto _ : state) {
    yaw += 0.01;
    const Eigen::Quaterniond q_WL(std::cos(0.5 * yaw), 0, 0, std::sin(0.5 * yaw));
    benchmark::DoNotOptimize(grid.insert(scan, {0.5 * std::cos(yaw), 0, 1}, q_WL));
  }
}
BENCHMARK(occupancy_update)->Name("occupancy/insert_1000_beams")->Unit(benchmark::kMicrosecond);

void distance_field(benchmark::State& state) {
  OccupancyGrid grid;
  (void)grid.insert(hall_scan(), {0, 0, 1}, Eigen::Quaterniond::Identity());
  DistanceField field;
  for (auto _ : state) {
    field.update(grid);
    benchmark::DoNotOptimize(field.values().data());
  }
  state.counters["cells"] = static_cast<double>(field.values().size());
}
BENCHMARK(distance_field)->Name("occupancy/distance_field")->Unit(benchmark::kMicrosecond);

/// A hall of 50 x 50 m with pillars, 1000 x 1000 cells, in which a scan's worth of obstacles comes
/// and goes. Goal: at most 2 ms.
void distance_field_update(benchmark::State& state) {
  OccupancyGrid grid(OccupancyGrid::Params(), {-25, -25}, 1000, 1000);
  for (int y = 0; y < 1000; ++y) {
    for (int x = 0; x < 1000; ++x) {
      const bool wall = x % 999 == 0 || y % 999 == 0 || (x % 80 < 6 && y % 80 < 6);
      grid.set_state({x, y}, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  DistanceField::Params params;
  params.max_distance = 1.0;
  DistanceField field(grid, params);
  const LaserScan scan = hall_scan();
  double x = 0.0;
  std::vector<double> times_ms;
  for (auto _ : state) {
    state.PauseTiming();
    x = x > 15.0 ? -15.0 : x + 0.05;
    (void)grid.insert(scan, {x, 0.02 * x, 1}, Eigen::Quaterniond::Identity());
    state.ResumeTiming();
    const auto begin = std::chrono::steady_clock::now();
    field.update(grid);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    times_ms.push_back(took.count());
  }
  std::sort(times_ms.begin(), times_ms.end());
  state.counters["p50_ms"] = times_ms[times_ms.size() / 2];
  state.counters["p99_ms"] = times_ms[times_ms.size() * 99 / 100];
  double cells = 0.0;
  for (const RowSpan& span : field.changed()) cells += span.last - span.first + 1;
  state.counters["cells_of_last"] = cells;
}
BENCHMARK(distance_field_update)
    ->Name("occupancy/distance_field_update_50_m")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swiftlet
