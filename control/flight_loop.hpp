// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "control/abandoned_flight.hpp"
#include "control/inertial_carry.hpp"
#include "control/mixer.hpp"
#include "control/reference_merge.hpp"
#include "control/se3_controller.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

enum class SetpointKind {
  kMotorsOff,
  kTrack,  ///< follow the reference
  kLevel,  ///< no position is known: brake and sink slowly
};

/// What the vehicle shall do from `time` on.
struct FlightSetpoint {
  Time time{};
  SetpointKind kind = SetpointKind::kMotorsOff;
  FlatReference reference;  ///< of kTrack
};

/// The reference `dt` seconds later, by its own derivatives.
FlatReference extrapolate(const FlatReference& reference, double dt);

/// When something was stamped, and at which step it was there first.
///
/// Fresh is what is stamped within a time and was heard within it, on the clock of the steps: a
/// stamp that runs ahead does not keep a dead sender alive. Stamps far ahead are of another clock.
struct Freshness {
  std::optional<Time> stamp;
  std::optional<Time> heard;  ///< none: since the last step

  /// The greater of both ages [s]; infinite where nothing was heard, or on another clock.
  double age(Time now) const;
  /// Whether a stamp could be of the clock that says `now`, and no older than `timeout` [s].
  static bool plausible(Time stamp, Time now, double timeout);
};

/// The innermost loop: setpoint, estimate and IMU to rotor thrusts.
///
/// Nothing stale is flown. What is flown instead goes down a ladder, each rung with what is left:
///   - the estimate is late: the state is carried on with the IMU, and all goes on as before;
///   - the setpoint is missing: brake, hold, and land after a while (AbandonedFlight);
///   - the estimate is missing: brake and sink on the velocity that the IMU gives;
///   - that is too old, too: keep level by the gyroscope alone, with a little less than the weight.
/// The motors stop when a commander who was there all the time says so, or after a landing. One who
/// says so after a gap was restarted and knows nothing of the flight; he is not obeyed in the air.
/// Motors that are off stay off until a fresh setpoint asks for them, and after a landing without a
/// commander until somebody said "off".
///
/// What is not finite is ignored, as if it had not come.
class FlightLoop {
 public:
  struct Params {
    Se3Controller::Params controller;
    double setpoint_timeout = 0.030;  ///< three periods of 100 Hz [s]
    double estimate_timeout = 0.030;  ///< three periods of 100 Hz, which estimators guarantee [s]
    double inertial_timeout = 0.25;   ///< for so long an estimate's position is carried on [s]
    double velocity_timeout = 4.0;    ///< and for so long its velocity [s]
    double landing_speed = 0.4;       ///< of every descent [m/s]
    double sinking_thrust_to_weight = 0.95;  ///< where no velocity is known
    double ground_time = 0.5;  ///< of sonar at the ground ends a descent without any command [s]
    InertialCarry::Params carry;
    AbandonedFlight::Params abandoned;  ///< its landing_speed is the one above
    GroundSonar::Params sonar;
    /// Of the way back from what was flown to the setpoint of a commander who is there again.
    ReferenceLimits merging{0.5, 1.5, 10.0, 2.0, 10.0};
  };

  enum class Behaviour {
    kMotorsOff,
    kTracking,
    kInertial,       ///< tracking, the state carried on with the IMU
    kLevel,          ///< braking and sinking, as asked
    kStaleSetpoint,  ///< braking and holding: nobody says where to go
    kAbandoned,      ///< landing: nobody did for a while
    kLanded,         ///< motors off, after a landing without a commander
    kStaleEstimate,  ///< braking and sinking: nobody knows where it is
    kBlind,          ///< level attitude, sinking: no velocity is known
  };

  struct Output {
    Behaviour behaviour = Behaviour::kMotorsOff;
    Eigen::Vector4d rotor_thrusts = Eigen::Vector4d::Zero();  ///< [N]
    TrackingOutput tracking;                                  ///< but for kBlind and motors off
    MixerOutput mixer;                                        ///< but for motors off
    FlatReference reference;                                  ///< what was flown, as `tracking`
    double setpoint_age = 0.0;                                ///< [s], infinite: never a good one
    double estimate_age = 0.0;                                ///< likewise
    bool armed() const {
      return behaviour != Behaviour::kMotorsOff && behaviour != Behaviour::kLanded;
    }
    bool motors_off_refused = false;  ///< somebody said so after a gap, since the last step
  };

  /// Throws std::invalid_argument where parameters or model cannot be flown with.
  FlightLoop(const Params& params, const QuadrotorModel& model);

  /// Other parameters, in flight: what is flown goes on, and the integral goes on asking for the
  /// same force. Throws as the constructor, and changes nothing then.
  void set_params(const Params& params);

  void set_estimate(Time time, const RigidBodyState& state);
  void set_setpoint(const FlightSetpoint& setpoint);
  /// Of the downward sonar [m], where there is one; infinite without an echo.
  void set_range_down(double range) { sonar_.set_range(range); }

  /// One step at `now` with a sample of the IMU, whose time it is.
  Output step(Time now, const ImuSample& imu);

  /// The state that is flown with.
  const RigidBodyState& state() const { return carry_.state(); }

 private:
  /// What is known of the vehicle, from little to much.
  enum class Knowledge { kAttitude, kVelocity, kPosition };
  /// What the last step flew by, so that the next one knows what begins.
  enum class Law { kOff, kTrack, kAbandoned, kSink, kLevel };

  void hear(Time now, double dt, const ImuSample& imu);
  Output fly(Time now, double dt);
  bool estimate_is_fresh(Time now) const;
  Knowledge knowledge(Time now) const;
  FlatReference continued() const;

  Output off(Behaviour behaviour);
  Output track(Time now, double dt);
  Output abandoned(Time now, double dt);
  Output sink(Time now, Behaviour behaviour);
  Output level(Behaviour behaviour);
  Output follow(Behaviour behaviour, const FlatReference& reference);

  Params params_;
  Se3Controller controller_;
  Mixer mixer_;
  InertialCarry carry_;
  GroundSonar sonar_;
  AbandonedFlight abandoned_;
  SteadyDescent descent_;
  Eigen::Vector3d descent_offset_ = Eigen::Vector3d::Zero();  // [m]
  ReferenceMerge merge_;

  FlightSetpoint setpoint_;
  Freshness setpoint_freshness_;
  std::optional<std::pair<Time, RigidBodyState>> new_estimate_;
  Freshness estimate_freshness_;
  std::optional<Time> last_step_;
  bool commanded_ = false;  // by a fresh setpoint at the last step
  std::optional<Time> uncommanded_since_;
  bool motors_off_refused_ = false;
  bool landed_alone_ = false;  // until somebody says "off"
  Law law_ = Law::kOff;
  FlatReference flown_;  // of the last step, carried on to this one
  PositionIntegral integral_;
};

/// What is flown and why, for a log: "nobody sends setpoints for 0.03 s: braking".
std::string describe(const FlightLoop::Output& output);

}  // namespace swiftlet
