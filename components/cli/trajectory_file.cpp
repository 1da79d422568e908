// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/cli/trajectory_file.hpp"

#include "components/planner/limits_config.hpp"
#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

// Far more than any flight [m, rad, m/s, m/s^2], and little enough for every sum and product.
constexpr Range kPlace{-1e6, 1e6};
constexpr Range kMotion{-1e3, 1e3};
constexpr Range kAngle{-100.0, 100.0};
constexpr Range kDuration{0.01, 3600.0};

std::optional<Eigen::Vector3d> read_optional(const Config& config, const std::string& key) {
  if (!config.has(key)) return std::nullopt;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  config.read(key, value, kMotion);
  return value;
}

}  // namespace

TrajectoryFile TrajectoryFile::load(const std::filesystem::path& file) {
  const Config config = Config::load(file);
  TrajectoryFile task;
  config.read("name", task.name);
  config.demand("start");
  const Config start = config.child("start");
  start.require("position", task.start.position, kPlace);
  start.read("yaw", task.start.yaw, kAngle);
  start.read("velocity", task.start.velocity, kMotion);
  start.read("acceleration", task.start.acceleration, kMotion);
  config.demand("waypoints");
  double yaw = task.start.yaw;  // kept until a waypoint says another
  for (const Config& item : config.list("waypoints")) {
    Waypoint waypoint;
    item.require("position", waypoint.position, kPlace);
    item.read("yaw", yaw, kAngle);
    waypoint.yaw = yaw;
    waypoint.velocity = read_optional(item, "velocity");
    waypoint.acceleration = read_optional(item, "acceleration");
    task.waypoints.push_back(waypoint);
  }
  if (task.waypoints.empty()) {
    config.fail("waypoints", "there are no waypoints; add at least one");
  }
  read_limits(config.child("limits"), task.limits);
  if (config.has("duration_s")) {
    double duration_s = 0.0;
    config.read("duration_s", duration_s, kDuration);
    task.duration_s = duration_s;
  }
  config.finish();
  return task;
}

}  // namespace swiftlet
