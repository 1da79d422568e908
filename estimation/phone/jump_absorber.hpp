// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "estimation/geometry/pose_history.hpp"

namespace swiftlet {

/// Follows measured poses of a vehicle that moves as far as physics lets it, and no further.
///
/// A pose that no motion leads to is withheld. If the next ones lead on from before, it was an
/// outlier; if they agree with it, what measures has found itself anew, elsewhere: a jump. The
/// output then goes on from where it was, without a step, and moves to where the measurement says
/// at a bounded speed, on top of the motion itself.
///
/// While a difference in heading is being worked off, measured motion is turned by it: so the
/// output stays one rigid motion, which agrees with what an IMU on the vehicle feels.
class JumpAbsorber {
 public:
  using Pose = PoseHistory::Pose;

  struct Params {
    double max_speed = 5.0;            ///< of the vehicle [m/s]
    double max_turn_rate = 6.0;        ///< of the vehicle [rad/s]
    double sigmas = 5.0;               ///< of noise that is no jump, besides [1]
    int confirmations = 5;             ///< poses at the new place that make a jump, one or more
    double follow_speed = 0.1;         ///< at which an absorbed jump is worked off [m/s]
    double follow_turn_rate = 0.0873;  ///< the same for its heading, 5 deg/s [rad/s]
  };
  struct Measurement {
    Time time{};  ///< later than that of the one before
    Pose pose;
    double position_sigma = 0.0;  ///< [m]
    double attitude_sigma = 0.0;  ///< [rad]
  };
  enum class Outcome {
    kFollowed,
    kWithheld,    ///< no motion leads there, as far as is known yet
    kJumped,      ///< it is a jump: absorbed
    kFalseStart,  ///< the poses before the jump were fewer than those that confirm it: what they
                  ///< were the start of was wrong, and the caller has to begin anew
  };
  /// From where motion would have led to where the measurement was.
  struct Jump {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
    double yaw = 0.0;  ///< [rad]; 0 where the attitude's own noise explains it
  };
  struct Output {
    Outcome outcome = Outcome::kWithheld;
    Pose pose;  ///< only where it is followed or jumped
    Jump jump;  ///< only where it jumped
  };

  explicit JumpAbsorber(const Params& params) : params_(params) {}

  Output follow(const Measurement& measurement);

  /// Output less measurement: what is still to be worked off, [m] and [rad].
  const Eigen::Vector3d& remaining() const { return remaining_; }
  double remaining_yaw() const { return remaining_yaw_; }
  /// The last output; nothing before the first.
  const std::optional<Pose>& last_output() const { return output_; }

 private:
  bool belongs_to_candidates(const Measurement& measurement) const;
  bool leads_to(const Measurement& from, const Measurement& to) const;
  bool turns_to(const Measurement& from, const Measurement& to) const;
  Jump absorb();
  void advance(const Measurement& measurement);

  Params params_;
  std::optional<Measurement> last_;  // that was followed
  std::vector<Measurement> candidates_;
  std::optional<Pose> output_;
  Eigen::Vector3d remaining_ = Eigen::Vector3d::Zero();
  double remaining_yaw_ = 0.0;
  int followed_ = 0;  // up to as many as `confirmations`
};

}  // namespace swiftlet
