// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "estimation/basics/result.hpp"
#include "perception/laser_scan.hpp"

namespace swiftlet {

/// Index of a cell: column x counts along the world's x axis, row y along its y axis.
struct Cell {
  int x = 0;
  int y = 0;
  bool operator==(const Cell& other) const { return x == other.x && y == other.y; }
  bool operator!=(const Cell& other) const { return !(*this == other); }
};

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// What became of the beams of a scan.
struct ScanInsertion {
  int returns = 0;   ///< ended in an obstacle inside the height band
  int clearing = 0;  ///< no return, or one outside the height band: only cleared
  int ignored = 0;   ///< unreadable, or never inside the height band
};

/// Horizontal log-odds occupancy grid from planar scans at known poses (Moravec and Elfes 1985;
/// Thrun, Burgard, Fox, Probabilistic Robotics, table 9.1).
///
/// Axis-aligned with the world W (ENU); cell (0,0) has its lower-left corner at origin(). Every
/// beam is levelled with the full pose of the scanner and clipped to the height band: only the part
/// of it inside the band clears cells, and only returns inside the band are obstacles, so that
/// floor and ceiling seen by a tilted vehicle never become walls. The grid grows as scans leave it.
///
/// A cell is updated at most once a scan, and a hit wins over the misses of the same scan, so the
/// order of the beams does not matter. Evidence of a cell is a log-odds in thousandths.
class OccupancyGrid {
 public:
  struct Params {
    double resolution = 0.05;          ///< edge of a cell [m]
    double hit_probability = 0.70;     ///< that a cell is occupied, given one return in it
    double miss_probability = 0.40;    ///< the same, given one beam through it
    double min_probability = 0.05;     ///< evidence is clamped, so that the map can change its mind
    double max_probability = 0.97;     ///<
    double occupied_threshold = 0.65;  ///< a cell above is occupied
    double free_threshold = 0.35;      ///< a cell below is free, one between is not known yet
    double min_height = 0.20;          ///< z of the world from which returns count [m]
    double max_height = 2.20;          ///< z of the world up to which returns count [m]
    double max_range = 1e9;            ///< beams are cut here, returns beyond only clear [m]
    bool clear_without_return = true;  ///< beams that saw nothing clear up to their range_max
    std::int64_t max_cells = 16'000'000;  ///< the grid refuses to grow beyond
  };

  /// Evidence of a cell that no beam has touched.
  static constexpr std::int16_t kNoEvidence = INT16_MIN;
  /// Units of evidence per unit of log-odds.
  static constexpr double kEvidencePerLogOdds = 1000.0;

  /// An empty grid, which grows with the first scan.
  OccupancyGrid();
  explicit OccupancyGrid(const Params& params);
  /// A grid of unknown cells. Empty where width or height is not positive or their product is above
  /// `max_cells`, or the origin is not finite.
  OccupancyGrid(const Params& params, const Eigen::Vector2d& origin, int width, int height);

  /// Adds one scan taken at the pose T_WL of the scanner (position p_WL [m], attitude q_WL).
  /// Refuses what is not finite and what would make the grid too large, and leaves the grid as it
  /// was.
  Result<ScanInsertion> insert(const LaserScan& scan, const Eigen::Vector3d& p_WL,
                               const Eigen::Quaterniond& q_WL);

  /// Enlarges the grid with unknown cells until it contains the box between two corners [m].
  Status cover(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper);

  const Params& params() const { return params_; }
  double resolution() const { return params_.resolution; }
  int width() const { return width_; }    ///< cells along x
  int height() const { return height_; }  ///< cells along y
  bool empty() const { return evidence_.empty(); }
  Eigen::Vector2d origin() const;  ///< lower-left corner of cell (0,0) in the world [m]

  bool contains(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_;
  }
  /// The cell around a point, which need not be inside the grid. Far and NaN points give cells
  /// outside the grid.
  Cell cell_of(const Eigen::Vector2d& point) const;
  Eigen::Vector2d center_of(Cell cell) const;

  /// Unknown outside of the grid.
  CellState state(Cell cell) const;
  /// The states of row `y`, which must be inside. For those who look at every cell often.
  void states_of_row(int y, std::vector<CellState>& states) const;
  /// That the cell is occupied; 0.5 where nothing is known.
  double probability(Cell cell) const;
  /// Log-odds in thousandths, kNoEvidence where no beam has been. Row by row from the lowest y.
  const std::vector<std::int16_t>& evidence() const { return evidence_; }

  /// Overwrites a cell: with the clamped extremes for occupied and free. No effect outside.
  void set_state(Cell cell, CellState state);
  /// Overwrites the evidence of a cell, clamped. NaN makes it unknown. No effect outside.
  void set_probability(Cell cell, double probability);
  /// Overwrites all cells: 0 to 100 % occupied, below unknown, row by row from the lowest y, as
  /// nav_msgs/OccupancyGrid has them. No effect where there are not as many.
  void set_percents(const std::vector<std::int8_t>& percents);

 private:
  struct Segment;  // a levelled, clipped beam in the plane
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.x);
  }
  void set_thresholds();
  Status cover_box(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, std::int64_t step);
  Status cover_cells(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1,
                     std::int64_t step);

  Params params_;
  Eigen::Vector2d anchor_ = Eigen::Vector2d::Zero();  // the lattice of the cells goes through it
  std::int64_t first_x_ = 0;  // of cell (0,0), in cells from the anchor: growth never shifts cells
  std::int64_t first_y_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::int16_t> evidence_;
  std::vector<std::uint8_t> touched_;  // scratch of insert()
  bool usable_ = false;                // the parameters make sense
  // Params in units of evidence.
  std::int16_t hit_ = 0, miss_ = 0, min_ = 0, max_ = 0, occupied_above_ = 0, free_below_ = 0;
};

}  // namespace swiftlet
