// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "perception/distance_field.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// What a map says of places and ways, at heights that it is of.
class KnownObstacles {
 public:
  /// `map` must outlive it. `clearance` is from the vehicle's centre to an obstacle [m].
  KnownObstacles(const OccupancyGrid& map, double clearance);

  bool covers(double height) const;  ///< [m], in the map
  bool knows(const Eigen::Vector2d& place) const;
  /// "is inside an obstacle", "is 0.12 m from an obstacle, ..."; "" where it is clear.
  std::string problem_at(const Eigen::Vector2d& place) const;
  /// The same of the first place on a straight way that is not clear.
  std::string problem_on(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  double free_at(const Eigen::Vector2d& place) const;

  const OccupancyGrid& map_;
  double clearance_;
  DistanceField field_;
};

}  // namespace swiftlet
