// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "control/mixer.hpp"
#include "control/se3_controller.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

enum class SetpointKind {
  kMotorsOff,
  kTrack,  ///< follow the reference
  kLevel,  ///< no position: keep level and sink slowly
};

/// What the vehicle shall do from `time` on.
struct FlightSetpoint {
  Time time{};
  SetpointKind kind = SetpointKind::kMotorsOff;
  FlatReference reference;  ///< of kTrack
};

/// The reference `dt` seconds later, by its own derivatives.
FlatReference extrapolate(const FlatReference& reference, double dt);

/// The innermost loop: setpoint, estimate and gyroscope to rotor thrusts.
///
/// The attitude is carried on from the last estimate with the gyroscope, so that the vehicle stays
/// upright for a while when the estimator dies. Nothing stale is flown: without a fresh setpoint
/// the vehicle keeps level at the thrust of hovering, without a fresh estimate it keeps level and
/// sinks. Motors that are off stay off.
///
/// Fresh is what is stamped within its timeout and was heard within it, on the clock of the steps:
/// a stamp that runs ahead does not keep a dead sender alive. Stamps far ahead are of another clock
/// and refused. What is not finite is ignored, as if it had not come.
class FlightLoop {
 public:
  struct Params {
    Se3Controller::Params controller;
    double setpoint_timeout = 0.030;  ///< three periods of 100 Hz [s]
    double estimate_timeout = 0.050;  ///< [s]
    double sinking_thrust_to_weight = 0.95;
  };

  enum class Behaviour {
    kMotorsOff,
    kTracking,
    kLevel,          ///< as asked
    kStaleSetpoint,  ///< level: nobody says where to go
    kStaleEstimate,  ///< level and sinking: nobody knows where it is
  };

  struct Output {
    Behaviour behaviour = Behaviour::kMotorsOff;
    Eigen::Vector4d rotor_thrusts = Eigen::Vector4d::Zero();  ///< [N]
    TrackingOutput tracking;                                  ///< of kTracking
    MixerOutput mixer;                                        ///< but for kMotorsOff
  };

  /// Throws std::invalid_argument where parameters or model cannot be flown with.
  FlightLoop(const Params& params, const QuadrotorModel& model);

  void set_estimate(Time time, const RigidBodyState& state);
  void set_setpoint(const FlightSetpoint& setpoint);

  /// One step at `now`, with the angular velocity that the gyroscope measures [rad/s, body]. One
  /// that is not finite is taken for the last good one.
  Output step(Time now, const Eigen::Vector3d& angular_velocity);

 private:
  /// When something was stamped, and at which step it was there first.
  struct Freshness {
    std::optional<Time> stamp;
    std::optional<Time> heard;  // none: since the last step
    bool within(double timeout, Time now) const;
  };

  void carry_attitude(Time now);
  Output level(Behaviour behaviour, double thrust_to_weight) const;
  Output track(Time now, double dt);

  Params params_;
  Se3Controller controller_;
  Mixer mixer_;
  FlightSetpoint setpoint_;
  Freshness setpoint_freshness_;
  Freshness estimate_freshness_;
  RigidBodyState state_;               // as estimated last, its attitude carried on
  std::optional<Time> attitude_time_;  // that to which it was carried on
  std::optional<Time> last_step_;
  PositionIntegral integral_;
};

}  // namespace swiftlet
