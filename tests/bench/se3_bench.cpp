// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Goal: one step of the controller, and of the innermost loop around it, within 2 us.
#include <benchmark/benchmark.h>

#include "control/flight_loop.hpp"
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

constexpr Duration kPeriod = std::chrono::milliseconds(4);

/// As on board: an estimate each step, a setpoint at 100 Hz, whoever is alive.
void fly(benchmark::State& state, bool estimator, bool commander, Duration silent) {
  FlightLoop loop({}, {});
  RigidBodyState vehicle = some_state();
  FlightSetpoint setpoint;
  setpoint.kind = SetpointKind::kTrack;
  setpoint.reference = some_reference();
  const ImuSample imu{{0.2, 0.1, -0.3}, {0.3, 0.2, 9.9}};
  Time now{std::chrono::seconds(1)};
  int k = 0;
  const auto step = [&](bool with_estimate, bool with_setpoint) {
    now += kPeriod;
    if (with_estimate) loop.set_estimate(now, vehicle);
    if (with_setpoint && ++k % 2 == 0) {
      setpoint.time = now;
      loop.set_setpoint(setpoint);
    }
    return loop.step(now, imu);
  };
  for (int i = 0; i < 1000; ++i) step(true, true);
  for (Time end = now + silent; now < end;) step(estimator, commander);
  const FlightLoop warm = loop;
  const Time begin = now;
  for (auto _ : state) {
    benchmark::DoNotOptimize(vehicle);
    benchmark::DoNotOptimize(step(estimator, commander));
    if (now - begin < std::chrono::seconds(1)) continue;
    loop = warm;  // one step of 250: what is flown must not change
    now = begin;
  }
}

void FlightLoopTracking(benchmark::State& state) {
  fly(state, true, true, {});
}
BENCHMARK(FlightLoopTracking)->Unit(benchmark::kMicrosecond);

void FlightLoopAbandoned(benchmark::State& state) {
  fly(state, true, false, std::chrono::milliseconds(40));
}
BENCHMARK(FlightLoopAbandoned)->Unit(benchmark::kMicrosecond);

void FlightLoopSinking(benchmark::State& state) {
  fly(state, false, false, std::chrono::milliseconds(300));
}
BENCHMARK(FlightLoopSinking)->Unit(benchmark::kMicrosecond);

/// The step that begins a brake from 1 m/s and 2 m/s^2: once a failure, not once a period.
void FlightLoopBeginsABrake(benchmark::State& state) {
  AbandonedFlight flight{{}};
  FlatReference reference = some_reference();
  reference.velocity = {0.8, 0.6, 0.0};
  reference.acceleration = {0.0, 2.0, 0.0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(reference);
    benchmark::DoNotOptimize(flight.begin({}, {}, reference).ok());
  }
}
BENCHMARK(FlightLoopBeginsABrake)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swiftlet
