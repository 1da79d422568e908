// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

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

}  // namespace
}  // namespace swiftlet
