// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "components/sim/claw_servo.hpp"
#include "components/sim/quadrotor.hpp"
#include "components/sim/sensors/battery.hpp"
#include "components/sim/sensors/gps.hpp"
#include "components/sim/sensors/imu.hpp"
#include "components/sim/sensors/lidar2d.hpp"
#include "components/sim/sensors/phone_pose.hpp"
#include "components/sim/sensors/sonar.hpp"
#include "components/sim/wind.hpp"

namespace swiftlet {

/// One flight to simulate: where, with what, and what is asked of the vehicle. The only source of
/// randomness of a run is `seed`.
struct Scenario {
  struct Start {
    double x = 0.0;           ///< [m]
    double y = 0.0;           ///< [m]
    std::optional<double> z;  ///< centre of mass [m]; without it, standing on the ground
    double yaw = 0.0;         ///< [rad]
  };
  struct Sensors {
    ImuSensor::Params imu0 = ImuSensor::mpu6000();
    ImuSensor::Params imu1 = ImuSensor::l3gd20h();
    ImuSensor::Params imu2 = ImuSensor::bno055();
    PhonePoseSensor::Params phone;
    Lidar2d::Params lidar;
    Sonar::Params sonar;
    Battery::Params battery;
    GpsSensor::Params gps;  ///< where the world says where on Earth it is
  };
  struct Waypoint {
    double x = 0.0;             ///< [m]
    double y = 0.0;             ///< [m]
    std::optional<double> z;    ///< [m]; else the altitude of take-off
    std::optional<double> yaw;  ///< [rad]; else as it comes
  };
  struct Mission {
    double takeoff_altitude = 1.2;  ///< above the world's origin [m]
    std::vector<Waypoint> waypoints;
    bool explore = false;  ///< instead of waypoints
    bool return_to_pad = true;
    bool land = true;
  };
  /// A box that is there for some time only, such as a door that closes.
  struct Obstacle {
    std::string name;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of its centre [m]
    double yaw = 0.0;                                    ///< [rad]
    Eigen::Vector3d size = Eigen::Vector3d::Zero();      ///< [m]
    double appears_at_s = 0.0;
    std::optional<double> disappears_at_s;
  };
  /// Somebody pushes the vehicle for a while: a force on its centre of mass.
  struct Push {
    double at_s = 0.0;
    double duration_s = 0.0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< in the world [N]
  };
  /// The area that a map of the world has to cover.
  struct MapBounds {
    Eigen::Vector2d min{-10.0, -10.0};  ///< [m]
    Eigen::Vector2d max{10.0, 10.0};    ///< [m]
    double resolution = 0.05;           ///< side of a cell [m]
  };

  std::string name;
  std::string description;
  std::uint64_t seed = 1;
  std::filesystem::path world;                    ///< SDFormat file
  std::vector<std::string> ground_models{"pad"};  ///< may be landed on, beside planes
  Quadrotor::Params vehicle;
  Start start;
  Wind::Params wind;
  Sensors sensors;
  Mission mission;
  std::vector<Obstacle> obstacles;
  std::vector<Push> pushes;
  std::optional<ClawServo::Params> claw;  ///< where the vehicle has one
  double time_limit_s = 300.0;
  MapBounds map;

  /// Reads a scenario file. Paths in it are relative to its folder. Throws ConfigError with file,
  /// line and remedy; unknown keys are refused.
  static Scenario load(const std::filesystem::path& file);
  /// The same from a mapping that is loaded already; calls `finish()` on it.
  static Scenario read(const Config& config);
};

/// The components that fly it, the simulator first.
std::vector<std::string> components_of(const Scenario& scenario);

}  // namespace swiftlet
