// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/static_transforms.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "nav_msgs.h"
#include "perception/near_obstacles.hpp"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace swiftlet {

/// What the LIDAR sees around the vehicle, on the map, for who has to stop in time: each scan at
/// the pose that odometry had when it was taken. Scans come before their odometry, so the last one
/// waits for it.
class Surroundings {
 public:
  struct Params {
    double min_height = 0.20;  ///< of returns, on the map; what is lower is the floor [m]
    double max_height = 2.20;  ///< what is higher is the ceiling [m]
    double max_range = 8.0;    ///< nobody needs longer to stop [m]
  };
  explicit Surroundings(const Params& params);
  Surroundings() : Surroundings(Params{}) {}

  void hear(const nav_msgs::msg::Odometry& odometry);
  void hear(const tf2_msgs::msg::TFMessage& mounts);
  void hear(const sensor_msgs::msg::LaserScan& scan);

  struct Seen {
    Time time{};
    NearObstacles obstacles;
  };
  /// What was seen last, once it can be placed; each scan once.
  std::optional<Seen> take();

 private:
  Params params_;
  StaticTransforms mounts_;
  PoseHistory body_;
  std::string body_frame_;
  std::optional<sensor_msgs::msg::LaserScan> waiting_;
};

}  // namespace swiftlet
