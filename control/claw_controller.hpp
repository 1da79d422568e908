// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Opens and closes a claw that a servo moves, by the length of its pulse, and holds what is
/// between its jaws with a limited current.
///
///     UNKNOWN ──open──▶ OPENING ──▶ OPEN         a new command leads from any state to OPENING or
///        └───close──▶ CLOSING ─┬▶ CLOSED         CLOSING; FAULT is left by one, or when a servo
///                              └▶ HOLDING        that was silent is heard again
///
/// A servo pushes harder the further its pulse leads where it stands. The pulse moves at a limited
/// rate and stops where the current says that the jaws are blocked. Closing, they have something
/// then: the pulse is led back until the servo draws `holding_current`, and follows what is held.
/// Opening, that is a fault. The claw does what it was told last until it is told something else:
/// nobody's silence opens it. Before the first command it leaves the servo alone.
class ClawController {
 public:
  struct Params {
    double pulse_open_us = 1000.0;
    double pulse_closed_us = 2000.0;  ///< more or less than open
    double travel_time = 0.8;         ///< from open to closed, the pulse takes that long [s]
    double tolerance_us = 30.0;       ///< so near to an end it is there
    double current_limit = 0.8;       ///< never more for long [A]
    double stall_current = 0.5;       ///< more than it takes to move: the jaws are blocked [A]
    double stall_time = 0.1;          ///< for so long [s]
    double holding_current = 0.3;     ///< that holds what is held [A]
    double holding_gain_us = 500.0;   ///< of the pulse, for each A and s of the current's error
    double patience = 1.0;            ///< beyond the travel time, for an end to be reached [s]
    double feedback_timeout = 0.2;    ///< a servo that says nothing for so long has failed [s]
  };
  /// As in swiftlet_msgs/ClawState.
  enum class State { kUnknown, kOpening, kOpen, kClosing, kClosed, kHolding, kFault };

  /// Throws std::invalid_argument, with a reason, where a parameter cannot be used.
  explicit ClawController(const Params& params);

  /// What the servo said; what is not finite is as good as nothing.
  void set_feedback(double pulse_us, double current, Time now);
  /// The same command again changes nothing.
  void command(bool open, Time now);
  /// At a fixed rate. The pulse for the servo; nothing where it is to be left alone.
  std::optional<double> tick(Time now);

  State state() const { return state_; }
  /// Of the jaws, 0 closed to 1 open; nothing where no servo is heard.
  std::optional<double> opening(Time now) const;
  std::optional<double> current(Time now) const;
  /// Of a fault.
  const std::string& reason() const { return reason_; }

 private:
  struct Feedback {
    double pulse_us;
    double current;
    Time heard;
  };
  bool hears(Time now) const;
  bool at(double pulse_us, double tolerance_us) const;
  double end(bool open) const { return open ? params_.pulse_open_us : params_.pulse_closed_us; }
  bool blocked(Time now);
  double within(double pulse_us) const;
  void move(double to_us, double step_us);
  void advance(Time now);
  void reach(bool open, Time now);
  void hold(double dt, double step_us);
  void begin(Time now);
  void fail(const std::string& reason);

  Params params_;
  State state_ = State::kUnknown;
  std::optional<bool> open_;  // what it was told last
  std::optional<Feedback> feedback_;
  std::optional<double> pulse_us_;
  std::optional<Time> last_tick_;
  std::optional<Time> blocked_since_;
  Time begun_{};         // to open or to close
  bool silent_ = false;  // that is the fault
  std::string reason_;
};

}  // namespace swiftlet
