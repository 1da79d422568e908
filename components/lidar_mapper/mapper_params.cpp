// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/mapper_params.hpp"

namespace swiftlet {
namespace {

void read_known_place(const Config& config, MapperParams& params) {
  const auto read_file = [&config, &params](const std::string& key, std::filesystem::path& file) {
    std::string name;
    config.read(key, name);
    if (name.empty()) return;
    if (!params.slam) config.fail(key, "map files are for 'slam: true'");
    file = config.folder() / name;
  };
  read_file("load", params.load);
  read_file("save", params.save);
  config.read("stay", params.stay);
  std::vector<double> pose;
  config.read("first_pose", pose);
  if (pose.empty()) return;
  if (pose.size() != 3) config.fail("first_pose", "is [x, y, yaw] in metres and radians");
  params.first_pose = Pose2{{pose[0], pose[1]}, pose[2]};
}

}  // namespace

MapperParams read_mapper_params(const Config& config) {
  MapperParams params;
  // A beam without an echo is as often a dark or slanted wall as open space.
  params.grid.clear_without_return = false;
  config.read("clear_without_return", params.grid.clear_without_return);
  config.read("resolution", params.grid.resolution, {0.005, 1.0});
  config.read("hit_probability", params.grid.hit_probability, {0.51, 0.99});
  config.read("miss_probability", params.grid.miss_probability, {0.01, 0.49});
  config.read("min_height", params.grid.min_height);
  config.read("max_height", params.grid.max_height);
  config.read("max_range", params.grid.max_range, kPositive);
  config.read("map_rate_hz", params.map_rate_hz, {0.1, 50.0});
  config.read("max_odometry_gap", params.max_odometry_gap, kPositive);

  LidarSlam::Params& slam = params.lidar_slam;
  config.read("slam", params.slam);
  config.read("max_speed", slam.motion.max_speed, kPositive);
  config.read("max_yaw_rate", slam.motion.max_yaw_rate, kPositive);
  config.read("odometry_distance", slam.odometry_distance, kPositive);
  config.read("odometry_distance_per_metre", slam.odometry_distance_per_metre, kNotNegative);
  config.read("odometry_angle", slam.odometry_angle, kPositive);
  config.read("odometry_angle_per_metre", slam.odometry_angle_per_metre, kNotNegative);
  config.read("odometry_angle_per_radian", slam.odometry_angle_per_radian, kNotNegative);
  config.read("keyframe_distance", slam.keyframe_distance, kPositive);
  config.read("keyframe_angle", slam.keyframe_angle, kPositive);
  config.read("loop_radius", slam.loops.radius, kPositive);
  read_known_place(config, params);
  return params;
}

}  // namespace swiftlet
