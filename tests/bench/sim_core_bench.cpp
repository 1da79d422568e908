// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <filesystem>

#include "components/sim/simulation.hpp"

namespace swiftlet {
namespace {

Scenario office() {
  return Scenario::load(std::filesystem::path(SWIFTLET_SOURCE_DIR) /
                        "components/sim/scenarios/office.yaml");
}

/// Physics, three IMUs, phone, sonar, battery and the scanner at 10 Hz: one second of flight.
/// Goal: at most 20 ms (50 times real time).
void simulate_one_second(benchmark::State& state) {
  Scenario scenario = office();
  scenario.wind.gust_intensity.setConstant(0.1);
  Simulation simulation(scenario);
  const double hover = scenario.vehicle.model.mass * kGravity / 4.0;
  for (auto _ : state) {
    for (int i = 0; i < 1000; ++i) {
      // Around 1.2 m, wherever the gusts take it: the walls push back.
      const double climb =
          0.5 * (1.2 - simulation.truth().body.p_WB.z()) - 0.5 * simulation.truth().body.v_WB_W.z();
      benchmark::DoNotOptimize(
          simulation.step(Simulation::kStep, Eigen::Vector4d::Constant(hover + climb)));
    }
  }
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(simulate_one_second)->Unit(benchmark::kMillisecond);

/// One scan of 1000 beams in the office. Goal: well under 0.2 ms.
void cast_1000_rays(benchmark::State& state) {
  const Simulation simulation(office());
  Eigen::Matrix3Xd beams(3, 1000);
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2e-3 * M_PI * i;
    beams.col(i) << std::cos(angle), std::sin(angle), 0.0;
  }
  std::vector<double> ranges;
  for (auto _ : state) {
    simulation.world().cast_rays({7.6, 4.8, 1.25}, beams, 12.0, ranges);
    benchmark::DoNotOptimize(ranges.data());
  }
}
BENCHMARK(cast_1000_rays)->Unit(benchmark::kMicrosecond);

void nearest_obstacle(benchmark::State& state) {
  const Simulation simulation(office());
  double x = 0.5;
  for (auto _ : state) {
    x = x < 12.0 ? x + 0.01 : 0.5;
    benchmark::DoNotOptimize(
        simulation.world().nearest({x, 1.05, 1.25}, 2.0, World::Surfaces::kObstacles));
  }
}
BENCHMARK(nearest_obstacle);

}  // namespace
}  // namespace swiftlet
