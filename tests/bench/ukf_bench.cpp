// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Goal: one prediction and one update within 10 us.
#include <benchmark/benchmark.h>

#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet {
namespace {

using std::chrono::milliseconds;

const ImuSample kImu{{0.1, -0.2, 0.3}, {0.3, 0.2, 9.7}};

PoseMeasurement pose() {
  PoseMeasurement z;
  z.covariance *= 1e-4;
  return z;
}

void UkfPredict(benchmark::State& state) {
  PoseImuUkf filter;
  (void)filter.initialize(Time{}, pose());
  Time time{};
  for (auto _ : state) {
    time += milliseconds(1);
    benchmark::DoNotOptimize(filter.predict(time, kImu));
    if (time > Time(std::chrono::seconds(1))) {
      state.PauseTiming();
      time = Time{};
      (void)filter.initialize(time, pose());
      state.ResumeTiming();
    }
  }
}
BENCHMARK(UkfPredict)->Unit(benchmark::kMicrosecond);

void UkfPredictAndUpdate(benchmark::State& state) {
  PoseImuUkf filter;
  (void)filter.initialize(Time{}, pose());
  const ImuSample hover{{0.0, 0.0, 0.0}, {0.0, 0.0, kGravity}};
  Time time{};
  std::int64_t used = 0;
  for (auto _ : state) {
    time += milliseconds(10);
    benchmark::DoNotOptimize(filter.predict(time, hover));
    used += filter.update(time, pose()).outcome == PoseImuUkf::Outcome::kUsed ? 1 : 0;
  }
  state.counters["used"] = static_cast<double>(used) / static_cast<double>(state.iterations());
}
BENCHMARK(UkfPredictAndUpdate)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swiftlet
