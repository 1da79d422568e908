// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/sim/random_stream.hpp"
#include "components/sim/sensors/sensor.hpp"

namespace swiftlet {

struct BatteryReading {
  Time time{};
  double voltage = 0.0;     ///< at the terminals [V]
  double current = 0.0;     ///< drawn [A]
  double charge = 0.0;      ///< left [A h]
  double percentage = 0.0;  ///< charge left of the capacity [0..1]
};

/// A lithium-polymer battery and its monitor (seed 004: 4S, 4,000 mAh, polled at 25 Hz).
///
/// Open-circuit voltage follows the state of charge, the terminals lose internal resistance times
/// current, and the current serves the power of the rotors (momentum theory: f^1.5 / sqrt(2 rho A)
/// over the efficiency) and of the electronics. An empty battery does not stop the rotors: the
/// flight stack has to land before.
class Battery {
 public:
  struct Params {
    double rate_hz = 25.0;
    int cells = 4;
    double capacity_mah = 4000.0;
    double charge_at_start = 1.0;       ///< of the capacity [0..1]
    double internal_resistance = 0.03;  ///< of the pack [ohm]
    double propeller_radius = 0.12;     ///< 9.5 inch across [m]
    double efficiency = 0.5;            ///< of propeller, motor and controller together [1]
    double electronics_power = 15.0;    ///< [W]
    double voltage_noise = 0.01;        ///< standard deviation [V]
    double current_noise = 0.05;        ///< standard deviation [A]
  };

  Battery(const Params& params, RandomStream random);

  /// Draws for the time since the last call; the reading that is due, or null. Valid until the
  /// next call.
  const BatteryReading* update(const VehicleTruth& truth);
  const Params& params() const { return params_; }
  double state_of_charge() const { return state_of_charge_; }

  /// Open-circuit voltage [V] of one cell at a state of charge [0..1].
  static double cell_voltage(double state_of_charge);

 private:
  Params params_;
  RandomStream random_;
  SampleClock clock_;
  double state_of_charge_;
  Time last_{};
  BatteryReading reading_;
};

}  // namespace swiftlet
