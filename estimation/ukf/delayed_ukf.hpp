// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet {

/// PoseImuUkf for poses that arrive late, as those of a camera do: each is applied at the time at
/// which it was taken, and the state is brought forward again.
///
/// Two filters: `anchor` stands at the last measurement, `present` at the last IMU sample. Between
/// them lie the samples that are needed to bring the one to the other. A measurement moves the
/// anchor on to its own time (the samples are interpolated there) and corrects it; the present is
/// then predicted anew. What comes out is bit for bit what a filter gives that had all measurements
/// in time, once both have seen the same.
///
/// Each sample is predicted with once when it comes, once by the anchor, and again for each
/// measurement that is older: at 1 kHz and 30 Hz with 100 ms of delay five predictions a sample.
class DelayedUkf {
 public:
  struct Params {
    PoseImuUkf::Params ukf;
    double max_delay = 0.2;  ///< of measurements; the anchor follows the present that far [s]
  };

  /// Throws std::invalid_argument as PoseImuUkf does.
  explicit DelayedUkf(const Params& params);

  /// Starts from a measured pose at rest. Samples that have come before are forgotten.
  Status initialize(Time time, const PoseMeasurement& measurement);

  /// Moves the present to `time`. Refused as by PoseImuUkf::predict. Believable samples after a gap
  /// are kept nevertheless: a pose that restarts the filter comes later than they but belongs
  /// before.
  Status predict(Time time, const ImuSample& imu);

  /// Corrects the state at `time` and brings it forward. Refused where that is before the last
  /// measurement, or more than `max_delay` ago. A measurement ahead of the IMU moves the present
  /// there, as in PoseImuUkf.
  UpdateReport update(Time time, const PoseMeasurement& measurement);

  bool initialized() const { return present_.initialized(); }
  /// The state at the last IMU sample.
  const PoseImuUkf& present() const { return present_; }

 private:
  struct Sample {
    Time time;
    ImuSample imu;
  };

  void keep_after_gap(const Sample& sample);
  void advance_anchor(Time time);
  void move_anchor(Time time);
  void predict_present();

  Params params_;
  PoseImuUkf anchor_;
  PoseImuUkf present_;
  std::vector<Sample> samples_;    ///< from the anchor to the present, oldest first
  std::optional<Sample> before_;   ///< the last one that the anchor has passed
  std::vector<Sample> after_gap_;  ///< refused by the present, the last `max_delay` of them
};

}  // namespace swiftlet
