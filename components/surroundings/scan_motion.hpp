// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/static_transforms.hpp"
#include "estimation/geometry/pose2.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "perception/levelled_scan.hpp"
#include "sensor_msgs.h"

namespace swiftlet {

/// Where a scanner is that sits `mount` on a body.
inline PoseHistory::Pose scanner_on(const PoseHistory::Pose& body,
                                    const StaticTransforms::Pose& mount) {
  return {body.position + body.attitude * mount.position, body.attitude * mount.attitude};
}

/// The frame beneath a scanner's origin that is level and looks the same way.
Pose2 planar(const PoseHistory::Pose& pose);

/// How the scanner was held when a scan began, and how it moved until the scan was over, by poses
/// of the body. `scanner`: its pose at the scan's stamp; gaps longer than `max_gap` are not
/// interpolated across. All returns are kept: heights are for the caller to set.
ScannerMotion scanner_motion(const sensor_msgs::msg::LaserScan& scan,
                             const PoseHistory::Pose& scanner, const PoseHistory& body,
                             const StaticTransforms::Pose& mount, Duration max_gap);

}  // namespace swiftlet
