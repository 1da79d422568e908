// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "control/flatness.hpp"
#include "control/flight_loop.hpp"
#include "tests/control/trajectories.hpp"
#include "tests/control/vehicle_simulation.hpp"

namespace swiftlet::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr Duration kMillisecond = std::chrono::milliseconds(1);

/// The circle needs more tilt than the default.
inline FlightLoop::Params agile() {
  FlightLoop::Params params;
  params.controller.max_tilt = 1.0;
  return params;
}

inline FlatReference hover_at(const Eigen::Vector3d& position) {
  FlatReference hover;
  hover.position = position;
  return hover;
}

/// Along x at 1 m/s.
inline FlatReference cruise(double t) {
  FlatReference reference = hover_at(Eigen::Vector3d(t, 0, 2));
  reference.velocity.x() = 1.0;
  return reference;
}

/// An IMU without errors on a vehicle that hovers.
inline ImuSample at_rest() {
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, kGravity)};
}

/// A vehicle, an estimator and a commander around the loop, as on board: control at 250 Hz,
/// estimates at 250 Hz, setpoints at 100 Hz.
struct LoopFlight {
  FlightLoop loop;
  Vehicle vehicle;
  Rotors rotors{QuadrotorModel{}};
  Time now{std::chrono::seconds(10)};
  std::int64_t milliseconds = 0;
  bool estimator = true, commander = true;
  SetpointKind kind = SetpointKind::kTrack;
  Duration stamps_ahead{};     // of setpoints
  Duration estimates_ahead{};  // of estimates
  std::function<FlatReference(double)> reference = [](double) {
    return hover_at(Eigen::Vector3d(0, 0, 2));
  };
  Eigen::Vector3d estimate_offset = Eigen::Vector3d::Zero();  // of the position [m]
  Eigen::Vector3d specific_force{0, 0, kGravity};
  std::optional<double> floor;  // [m]
  std::function<std::optional<double>()> sonar = [] { return std::nullopt; };
  FlightLoop::Output output;

  explicit LoopFlight(const FlightLoop::Params& params = agile()) : loop(params, {}) {
    vehicle.p = Eigen::Vector3d(0, 0, 2);
  }
  void cruises() {
    reference = cruise;
    vehicle.place(flat_state(cruise(t())));
  }

  double t() const { return static_cast<double>(milliseconds) * 1e-3; }

  /// One millisecond.
  void step() {
    if (commander && milliseconds % 10 == 0) {
      loop.set_setpoint({now + stamps_ahead, kind, reference(t())});
    }
    if (estimator && milliseconds % 4 == 1) {
      RigidBodyState state = vehicle.state();
      state.p_WB += estimate_offset;
      loop.set_estimate(now + estimates_ahead, state);
    }
    if (milliseconds % 50 == 0) {
      if (const std::optional<double> range = sonar()) loop.set_range_down(*range);
    }
    if (milliseconds % 4 == 0) output = loop.step(now, {vehicle.w, specific_force});
    move();
    now += kMillisecond;
    ++milliseconds;
  }

  void move() {
    const Eigen::Vector3d before = vehicle.v;
    vehicle.step(rotors.step(output.rotor_thrusts, 1e-3), 1e-3);
    if (floor && vehicle.p.z() < *floor) {
      vehicle.p.z() = *floor;
      vehicle.v.setZero();
      vehicle.w.setZero();
    }
    specific_force =
        vehicle.R.transpose() * ((vehicle.v - before) / 1e-3 + Eigen::Vector3d(0, 0, kGravity));
  }

  void fly_for(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds * 1e3 + 0.5); ++k) step();
  }
};

}  // namespace swiftlet::test
