// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// A servo that moves the jaws of a claw: a first-order lag behind its pulse with a limited speed.
/// It draws little while it moves, and the more the further its pulse leads where something rigid
/// stops it.
class ClawServo {
 public:
  struct Params {
    double pulse_open_us = 1000.0;
    double pulse_closed_us = 2000.0;
    double max_speed_us = 2500.0;  ///< of the pulse at which it stands [us/s]
    double time_constant = 0.03;   ///< [s]
    double idle_current = 0.02;    ///< [A]
    double moving_current = 0.15;  ///< at full speed [A]
    double stall_gain = 0.004;     ///< of the pulse that leads [A/us]
    double stall_current = 1.5;    ///< the most that it draws [A]
    bool object = false;           ///< between the jaws
    double object_opening = 0.4;   ///< where they touch it, 0 closed to 1 open
    bool jammed = false;           ///< opens no further than `start_opening`
    double start_opening = 1.0;
  };

  explicit ClawServo(const Params& params);

  /// What is not finite is no pulse: it stays with the one before.
  void set_pulse(double pulse_us);
  /// Takes the object out, or puts one in as far as the jaws are open.
  void set_object(bool there) { params_.object = there; }
  void step(Duration duration);

  /// The pulse at which it would stand where it is.
  double position_us() const { return pulse_of(opening_); }
  double opening() const { return opening_; }
  double current() const { return current_; }  ///< [A]

 private:
  double pulse_of(double opening) const {
    return params_.pulse_closed_us + opening * (params_.pulse_open_us - params_.pulse_closed_us);
  }

  Params params_;
  double opening_;
  double pulse_us_;
  double current_;
};

}  // namespace swiftlet
