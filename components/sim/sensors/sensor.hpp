// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "components/sim/quadrotor.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Pose of a sensor S in the body: p_BS [m] and q_BS.
struct Mount {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// When a sensor samples: sample k at k / rate, rounded up to the simulator's step, so that the
/// rate holds over any time without drift.
class SampleClock {
 public:
  /// Zero or less never samples.
  explicit SampleClock(double rate_hz) : rate_hz_(rate_hz) {}

  /// Whether a sample is due at `now`. A step over several samples gives one.
  bool due(Time now) {
    if (!(rate_hz_ > 0.0) || now < next()) return false;
    while (now >= next()) ++count_;
    return true;
  }
  double rate_hz() const { return rate_hz_; }

 private:
  Time next() const { return Time(from_seconds(static_cast<double>(count_) / rate_hz_)); }

  double rate_hz_;
  std::int64_t count_ = 1;
};

/// `value` on the grid of a converter with the step `resolution`; zero for a continuous one.
double quantised(double value, double resolution);

}  // namespace swiftlet
