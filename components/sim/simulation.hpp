// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "components/sim/scenario.hpp"
#include "components/sim/world.hpp"

namespace swiftlet {

/// The sensor readings of one step: null where no sample is due. They stay valid until the next
/// step.
struct SensorReadings {
  std::array<const ImuReading*, 3> imu{};
  const PhonePoseReading* phone = nullptr;
  const LaserScanReading* scan = nullptr;
  const RangeReading* range_down = nullptr;
  const BatteryReading* battery = nullptr;
  const GpsReading* gps = nullptr;
};

/// A vehicle with its sensors in its world. It asks no clock and holds all its state: the same
/// scenario and the same commands give the same readings, bit for bit.
class Simulation {
 public:
  /// The step that the vehicle is simulated with.
  static constexpr Duration kStep = std::chrono::milliseconds(1);

  /// Throws ConfigError where the world cannot be loaded or the vehicle starts inside of
  /// something.
  explicit Simulation(const Scenario& scenario);

  /// Moves on by `dt`, normally kStep, with the thrust asked of each rotor [N] (see
  /// Quadrotor::step). No allocation, but when obstacles appear or collisions are noted.
  SensorReadings step(Duration dt, const Eigen::Vector4d& thrust_commands);

  Time time() const { return vehicle_.truth().time; }
  /// Ground truth: state, specific force, rotor thrusts.
  const VehicleTruth& truth() const { return vehicle_.truth(); }
  /// Collisions with anything but the ground: how many, and what is known of them.
  int contacts() const { return vehicle_.hull().count(); }
  const std::vector<Collision>& collisions() const { return vehicle_.hull().collisions(); }
  /// Smallest distance [m] of the hull to anything but the ground, at any step in the air;
  /// infinite before the first. Negative is a collision.
  double min_clearance() const { return vehicle_.hull().min_clearance(); }

  const World& world() const { return world_; }
  const Scenario& scenario() const { return scenario_; }
  /// Centre of mass at the start, resting [m].
  const Eigen::Vector3d& start() const { return start_; }

 private:
  void move_obstacles();
  Eigen::Vector3d push() const;

  Scenario scenario_;
  World world_;
  Quadrotor vehicle_;
  Wind wind_;
  std::array<ImuSensor, 3> imus_;
  PhonePoseSensor phone_;
  Lidar2d lidar_;
  Sonar sonar_;
  Battery battery_;
  GpsSensor gps_;
  std::vector<bool> obstacle_is_there_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet
