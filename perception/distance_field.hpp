// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// Cells of one row, `first` and `last` included.
struct RowSpan {
  int y = 0;
  int first = 0;
  int last = 0;
};

/// Exact Euclidean distance from the centre of each cell to the centre of the nearest obstacle
/// cell, cut off at a largest distance, by the two-pass lower-envelope transform (Felzenszwalb and
/// Huttenlocher, Distance Transforms of Sampled Functions, 2012, section 2).
///
/// A value type with the geometry of the grid that it was made from. `update` takes the grid as it
/// is now and works where obstacles came or went, as far as `max_distance` around them: its cost
/// grows with what changed. The result is the one of a new field, to the bit.
class DistanceField {
 public:
  struct Params {
    bool unknown_is_obstacle = false;
    double max_distance = 1e3;  ///< [m] where there is no obstacle nearer
  };

  DistanceField();
  explicit DistanceField(const Params& params);
  DistanceField(const OccupancyGrid& grid, const Params& params);

  /// Makes the field that of `grid`. Another geometry than before is a new field.
  void update(const OccupancyGrid& grid);
  /// The cells outside of which the last update left every distance as it was. Disjoint, row by
  /// row; all cells after a change of geometry.
  const std::vector<RowSpan>& changed() const { return changed_; }

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }
  const Eigen::Vector2d& origin() const { return origin_; }
  bool empty() const { return distance_.empty(); }
  bool contains(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_;
  }

  /// [m]. Zero in an obstacle. `cell` must be inside.
  double distance(Cell cell) const {
    return distance_[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(cell.x)];
  }
  /// Bilinear between the centres of cells [m]; the field is extended beyond its edge by the values
  /// at the edge. `max_distance` in an empty field, zero at a point that is not finite.
  double distance_at(const Eigen::Vector2d& point) const;

  /// Row by row from the lowest y [m].
  const std::vector<float>& values() const { return distance_; }

 private:
  struct ColumnSpan;
  void start_over(const OccupancyGrid& grid);
  bool is_obstacle(CellState state) const;
  int reach() const;
  std::vector<ColumnSpan> take_obstacles(const OccupancyGrid& grid);
  std::vector<RowSpan> update_columns(const std::vector<ColumnSpan>& columns);
  void update_rows(const std::vector<RowSpan>& spans);

  Params params_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double resolution_ = 1.0;
  int width_ = 0;
  int height_ = 0;
  std::vector<CellState> states_;
  std::vector<std::int32_t> vertical_;  // cells to the nearest obstacle in the column, cut off
  std::vector<float> distance_;
  std::vector<RowSpan> changed_;
};

}  // namespace swiftlet
