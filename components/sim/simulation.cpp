// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/simulation.hpp"

#include <fmt/format.h>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {

using Eigen::Vector3d;

Simulation::Simulation(const Scenario& scenario)
    : scenario_(scenario),
      world_(World::load(scenario.world, scenario.ground_models)),
      vehicle_(scenario.vehicle),
      wind_(scenario.wind, RandomStream(scenario.seed, "wind")),
      imus_{ImuSensor(scenario.sensors.imu0, RandomStream(scenario.seed, "imu0")),
            ImuSensor(scenario.sensors.imu1, RandomStream(scenario.seed, "imu1")),
            ImuSensor(scenario.sensors.imu2, RandomStream(scenario.seed, "imu2"))},
      phone_(scenario.sensors.phone, RandomStream(scenario.seed, "phone")),
      lidar_(scenario.sensors.lidar, RandomStream(scenario.seed, "lidar")),
      sonar_(scenario.sensors.sonar, RandomStream(scenario.seed, "sonar")),
      battery_(scenario.sensors.battery, RandomStream(scenario.seed, "battery")),
      gps_(scenario.sensors.gps, world_.local_origin(), RandomStream(scenario.seed, "gps")),
      obstacle_is_there_(scenario.obstacles.size(), false) {
  const Scenario::Start& start = scenario.start;
  const double ground = world_.ground_height(start.x, start.y).value_or(0.0);
  start_ = {start.x, start.y, start.z.value_or(ground + scenario.vehicle.ground.leg_height)};
  move_obstacles();
  const double radius = scenario.vehicle.hull.radius;
  const auto nearest = world_.nearest(start_, radius, World::Surfaces::kObstacles);
  if (nearest && nearest->distance < radius) {
    throw ConfigError(
        fmt::format("scenario '{}': the vehicle (radius {} m) starts inside of model '{}'; move "
                    "'start' ({}, {})",
                    scenario.name, radius, nearest->model, start.x, start.y));
  }
  RigidBodyState body;
  body.p_WB = start_;
  body.q_WB = from_yaw(start.yaw);
  vehicle_.reset(Time{}, body);
}

SensorReadings Simulation::step(Duration dt, const Eigen::Vector4d& thrust_commands) {
  if (dt <= Duration::zero()) return {};
  move_obstacles();
  wind_.step(dt);
  vehicle_.step(dt, thrust_commands, wind_.velocity(), world_, push());

  const VehicleTruth& truth = vehicle_.truth();
  SensorReadings readings;
  for (std::size_t i = 0; i < imus_.size(); ++i) readings.imu[i] = imus_[i].update(truth);
  readings.phone = phone_.update(truth);
  readings.scan = lidar_.update(truth, world_);
  readings.range_down = sonar_.update(truth, world_);
  readings.battery = battery_.update(truth);
  readings.gps = gps_.update(truth);
  return readings;
}

/// The force of all who push at present [N].
Vector3d Simulation::push() const {
  Vector3d force = Vector3d::Zero();
  for (const Scenario::Push& push : scenario_.pushes) {
    const Time begin{from_seconds(push.at_s)};
    const Duration lasted = vehicle_.truth().time - begin;
    if (lasted >= Duration(0) && lasted < from_seconds(push.duration_s)) force += push.force;
  }
  return force;
}

void Simulation::move_obstacles() {
  const double now_s = to_seconds(vehicle_.truth().time);
  for (std::size_t i = 0; i < obstacle_is_there_.size(); ++i) {
    const Scenario::Obstacle& obstacle = scenario_.obstacles[i];
    const bool due = now_s >= obstacle.appears_at_s &&
                     !(obstacle.disappears_at_s && now_s >= *obstacle.disappears_at_s);
    if (due == obstacle_is_there_[i]) continue;
    obstacle_is_there_[i] = due;
    if (due) {
      Eigen::Isometry3d T_WS = Eigen::Isometry3d::Identity();
      T_WS.translation() = obstacle.position;
      T_WS.linear() = from_yaw(obstacle.yaw).toRotationMatrix();
      world_.add_box(obstacle.name, T_WS, obstacle.size);
    } else {
      world_.remove(obstacle.name);
    }
  }
}

}  // namespace swiftlet
