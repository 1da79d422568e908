// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/battery.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace swiftlet {

namespace {

constexpr double kAirDensity = 1.225;  // at sea level, 15 degrees Celsius [kg/m^3]

// Resting voltage of a lithium-polymer cell at 0, 5, 10 ... 100 % of its charge [V].
constexpr std::array<double, 21> kCellVoltage{3.27, 3.61, 3.69, 3.71, 3.73, 3.75, 3.77,
                                              3.79, 3.80, 3.82, 3.84, 3.85, 3.87, 3.91,
                                              3.95, 3.98, 4.02, 4.08, 4.11, 4.15, 4.20};

double power_of(const Battery::Params& params, const Eigen::Vector4d& thrusts) {
  const double disc = M_PI * params.propeller_radius * params.propeller_radius;
  double power = params.electronics_power;
  for (const double thrust : thrusts) {
    const double f = std::max(thrust, 0.0);
    power += f * std::sqrt(f / (2.0 * kAirDensity * disc)) / params.efficiency;
  }
  return power;
}

/// The smaller root of (V - R I) I = P. Where the pack cannot give P, the current at which it
/// gives the most.
double current_of(double power, double voltage, double resistance) {
  if (resistance <= 0.0) return power / voltage;
  const double discriminant = voltage * voltage - 4.0 * resistance * power;
  return (voltage - std::sqrt(std::max(discriminant, 0.0))) / (2.0 * resistance);
}

}  // namespace

double Battery::cell_voltage(double state_of_charge) {
  const double position = 20.0 * std::clamp(state_of_charge, 0.0, 1.0);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(position), 19);
  const double s = position - static_cast<double>(below);
  return kCellVoltage[below] + s * (kCellVoltage[below + 1] - kCellVoltage[below]);
}

Battery::Battery(const Params& params, RandomStream random)
    : params_(params),
      random_(random),
      clock_(params.rate_hz),
      state_of_charge_(std::clamp(params.charge_at_start, 0.0, 1.0)) {}

const BatteryReading* Battery::update(const VehicleTruth& truth) {
  const double open_circuit = params_.cells * cell_voltage(state_of_charge_);
  const double current =
      current_of(power_of(params_, truth.rotor_thrusts), open_circuit, params_.internal_resistance);
  const double capacity = 1e-3 * params_.capacity_mah;  // [A h]
  const double hours = to_seconds(truth.time - last_) / 3600.0;
  state_of_charge_ = std::clamp(state_of_charge_ - current * hours / capacity, 0.0, 1.0);
  last_ = truth.time;
  if (!clock_.due(truth.time)) return nullptr;

  reading_.time = truth.time;
  reading_.voltage = open_circuit - params_.internal_resistance * current +
                     params_.voltage_noise * random_.normal();
  reading_.current = current + params_.current_noise * random_.normal();
  reading_.charge = state_of_charge_ * capacity;
  reading_.percentage = state_of_charge_;
  return &reading_;
}

}  // namespace swiftlet
