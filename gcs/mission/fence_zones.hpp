// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gcs/mission/mission_track.hpp"

namespace swiftlet {

/// The fence of a mission file, in the plane of a track.
class FenceZones {
 public:
  FenceZones(const std::vector<FenceZone>& zones, const LocalOrigin& origin);

  /// Why a straight way from one place to another cannot be flown, with the place [m]; "" where it
  /// can.
  std::string problem_of_way(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  struct Zone {
    bool stay_inside = true;
    int line = 0;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double radius = 0.0;
    std::vector<Eigen::Vector2d> corners;
    bool contains(const Eigen::Vector2d& point) const;
  };
  std::string problem_at(const Eigen::Vector2d& point) const;

  std::vector<Zone> zones_;
  bool keeps_in_ = false;
};

}  // namespace swiftlet
