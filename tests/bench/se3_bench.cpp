// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Goal: one step of the controller within 2 us.
#include <benchmark/benchmark.h>

#include "control/mixer.hpp"
#include "control/se3_controller.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

RigidBodyState some_state() {
  return {{0.1, -0.1, 1.1}, exp_so3({0.1, 0.2, 0.3}), {0.3, 0.1, -0.1}, {0.2, 0.1, -0.3}};
}

FlatReference some_reference() {
  FlatReference reference;
  reference.position = {0.0, 0.0, 1.0};
  reference.velocity = {0.5, 0.0, 0.0};
  reference.acceleration = {0.2, 0.3, 0.1};
  reference.jerk = {0.1, -0.5, 0.2};
  reference.snap = {0.4, 0.1, 0.3};
  reference.yaw = 0.3;
  reference.yaw_rate = 0.1;
  return reference;
}

void Se3Step(benchmark::State& state) {
  const Se3Controller controller({}, {});
  RigidBodyState vehicle = some_state();
  FlatReference reference = some_reference();
  for (auto _ : state) {
    benchmark::DoNotOptimize(vehicle);
    benchmark::DoNotOptimize(reference);
    benchmark::DoNotOptimize(controller.compute(vehicle, reference));
  }
}
BENCHMARK(Se3Step)->Unit(benchmark::kMicrosecond);

void Se3StepAndMix(benchmark::State& state) {
  const Se3Controller controller({}, {});
  const Mixer mixer{QuadrotorModel{}};
  RigidBodyState vehicle = some_state();
  FlatReference reference = some_reference();
  for (auto _ : state) {
    benchmark::DoNotOptimize(vehicle);
    benchmark::DoNotOptimize(reference);
    benchmark::DoNotOptimize(mixer.mix(controller.compute(vehicle, reference).wrench));
  }
}
BENCHMARK(Se3StepAndMix)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swiftlet
