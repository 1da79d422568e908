// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/lidar_mapper/mapper_params.hpp"
#include "components/lidar_mapper/slam_mapper.hpp"
#include "components/static_transforms.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"

namespace swiftlet {

/// SlamMapper between messages: scans and poses of the body go in, poses of the body come out.
class ScanLocator {
 public:
  ScanLocator(const MapperParams& params, Mailbox& mailbox, const Executor& executor,
              std::optional<KnownPlace> place);

  /// Where the body was when the scan was taken. `odometry`: what it says by now, which may be
  /// nothing; `mount`: where the scanner sits on the body.
  geometry_msgs::msg::PoseWithCovarianceStamped locate(const sensor_msgs::msg::LaserScan& scan,
                                                       const PoseHistory& odometry,
                                                       const StaticTransforms::Pose& mount);
  /// The last scan could not be matched.
  bool lost() const { return lost_; }
  /// All poses of the body, as known by now.
  nav_msgs::msg::Path path(Time now) const;
  const SlamMapper& slam() const { return slam_; }

 private:
  PoseHistory::Pose body_at(const Pose2& pose) const;

  MapperParams params_;
  SlamMapper slam_;
  bool lost_ = false;
  ScannerMotion motion_;          // at the last scan
  StaticTransforms::Pose mount_;  // of the last scan
};

}  // namespace swiftlet
