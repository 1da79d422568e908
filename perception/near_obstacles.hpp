// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace swiftlet {

/// What was seen around the vehicle a moment ago, as points on the map: for who must stop in time
/// and does not plan. What was not seen is free.
class NearObstacles {
 public:
  NearObstacles() = default;
  /// Points on the map [m]; what is no number is left out.
  explicit NearObstacles(std::vector<Eigen::Vector2d> points);

  /// The point nearest to a place [m], where there is one.
  std::optional<Eigen::Vector2d> nearest(const Eigen::Vector2d& place) const;
  /// From a place to the nearest point [m]; infinite where there is none.
  double clearance(const Eigen::Vector2d& place) const;

  /// How far a disc can go from a place in a direction (a unit vector) until it touches a point
  /// [m]; infinite where it never does. Points that are in the disc already leave it no way towards
  /// them, and do not keep it from going away.
  double free_way(const Eigen::Vector2d& place, const Eigen::Vector2d& direction,
                  double radius) const;

 private:
  std::vector<Eigen::Vector2d> points_;
};

}  // namespace swiftlet
