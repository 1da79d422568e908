// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "gcs/mission/mission_check.hpp"

namespace swiftlet {

/// One item as it would be flown.
struct MissionLeg {
  bool flies = false;        ///< from one place to another: to a waypoint, or back
  bool is_straight = false;  ///< without a planner that finds a way around obstacles
  bool in_map = true;        ///< `from` and `to` are; else in the plane of the track's origin
  bool is_known = true;      ///< `from` and `to` are in the same of both, and known
  bool has_begin = true;     ///< `from` is known
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
  double length = 0.0;                             ///< 0 where it is not known [m]
  double duration = 0.0;                           ///< [s]
  double way_home = 0.0;  ///< from its end until it stands on the take-off point [s]
};

/// Where a mission leads. What lies on Earth is in the map where anybody knows where that is on
/// Earth; else in a plane of its own at the first waypoint there.
struct MissionTrack {
  std::optional<LocalOrigin> origin;  ///< of the map, or else of that plane
  bool is_of_map = false;
  std::vector<MissionLeg> legs;  ///< one for each item
};

MissionTrack track_of(const MissionFile& mission, const MissionCheckParams& params);

}  // namespace swiftlet
