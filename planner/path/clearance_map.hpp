// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "estimation/basics/result.hpp"
#include "perception/distance_field.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// What a path costs, per metre.
struct PathCost {
  double radius = 0.25;               ///< of the disc that contains the vehicle [m]
  double margin = 0.10;               ///< never nearer to an obstacle than radius + margin [m]
  double preferred_clearance = 0.80;  ///< from the centre; nearer to an obstacle costs more [m]
  double clearance_weight = 8.0;      ///< added per metre at radius + margin, falling quadratically
  double unknown_weight = 0.5;        ///< added per metre of unknown space
  bool unknown_is_free = true;        ///< false: unknown space is an obstacle

  double hard_clearance() const { return radius + margin; }  ///< [m], of the centre
  /// Of the centre, where no obstacle costs anything [m].
  double free_clearance() const { return std::max(hard_clearance(), preferred_clearance); }
};

/// An occupancy grid as a planner sees it: how far the nearest obstacle is, what is unknown, and
/// what a metre costs. The world outside of the grid is unknown space. A border of it as wide as
/// obstacles are felt, where the unknown is free, makes the map an open one: nothing outside needs
/// cells of its own then, however far it is.
///
/// Clearance is the bilinear distance between centres less half a cell, the distance to the face of
/// the nearest obstacle cell. It can be up to 0.21 cells too large beside a single corner. Beyond
/// `known_clearance()`, which is above all that costs, it is cut off there: so an update needs to
/// look only so far around what changed.
class ClearanceMap {
 public:
  /// An empty map: no place in it.
  ClearanceMap() = default;

  /// A map without a place in it, to be updated. `reach` and `border` as in `update`.
  explicit ClearanceMap(const PathCost& cost);

  /// Makes the map that of `grid`, with `border` metres of unknown space around it and around the
  /// points of `reach`. Its cost grows with what changed since the last update, but for one look at
  /// each cell; the area never shrinks, and grows by some metres at a time, so that a map that
  /// grows does not make it a new one at every step. Fails on an empty grid, on points that are not
  /// finite, and where grid and points together would need more cells than the grid's `max_cells`;
  /// the map is empty then.
  Status update(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& reach = {},
                double border = 0.0);
  /// A new map, updated once.
  static Result<ClearanceMap> make(const OccupancyGrid& grid, const PathCost& cost,
                                   const std::vector<Eigen::Vector2d>& reach = {},
                                   double border = 0.0);

  int width() const { return field_.width(); }
  int height() const { return field_.height(); }
  bool empty() const { return field_.empty(); }
  double resolution() const { return field_.resolution(); }
  const Eigen::Vector2d& origin() const { return field_.origin(); }
  const PathCost& cost() const { return cost_; }
  const DistanceField& field() const { return field_; }

  /// Whether the world goes on outside as unknown space, to be flown through. Otherwise nothing
  /// leads there.
  bool open() const { return open_; }
  bool contains(Cell cell) const { return field_.contains(cell); }
  bool contains(const Eigen::Vector2d& point) const { return contains(cell_of(point)); }
  /// {-1, -1} of a point outside.
  Cell cell_of(const Eigen::Vector2d& point) const;
  Eigen::Vector2d center_of(Cell cell) const;
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(cell.x);
  }

  /// What clearance is cut off at [m].
  double known_clearance() const { return known_clearance_; }
  /// [m]. The cell must be inside.
  double clearance(Cell cell) const { return field_.distance(cell) - 0.5 * resolution(); }
  /// [m]. Outside of an open map `known_clearance()`, of another negative; so is that of a point
  /// that is not finite.
  double clearance_at(const Eigen::Vector2d& point) const;
  bool is_free(Cell cell) const { return density(cell) < std::numeric_limits<float>::infinity(); }
  bool unknown_at(const Eigen::Vector2d& point) const;

  /// Cost of a metre at a point; infinite where the centre of the vehicle must not be.
  double density_at(const Eigen::Vector2d& point) const;
  /// Cost of the straight line between two points, sampled every half cell; infinite where a part
  /// of it must not be flown.
  double segment_cost(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Cost of the metre at the centre of a cell, without interpolation.
  double density(Cell cell) const { return density_[index(cell)]; }

 private:
  double penalty(double clearance) const;
  double inner_cost(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

  Status check_cost() const;
  Result<OccupancyGrid> pad(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& reach,
                            double border) const;
  void set_density(Cell cell);

  PathCost cost_;
  double known_clearance_ = 0.0;
  bool open_ = false;
  DistanceField field_;
  std::vector<std::uint8_t> unknown_;
  std::vector<float> density_;
};

}  // namespace swiftlet
