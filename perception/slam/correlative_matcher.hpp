// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimation/geometry/pose2.hpp"
#include "perception/slam/scan_points.hpp"

namespace swiftlet {

/// How likely a return is at each place, given points of a map: exp(-d^2 / 2 sigma^2) of the
/// distance d to the nearest. Kept at several resolutions, coarse ones as upper bounds of what the
/// fine ones have.
class LikelihoodField {
 public:
  struct Params {
    double resolution = 0.10;  ///< [m]
    double sigma = 0.10;       ///< [m]
    int levels = 7;            ///< the coarsest covers 2^(levels - 1) cells
  };
  LikelihoodField(const std::vector<Eigen::Vector2d>& points, const Params& params);

  int levels() const { return static_cast<int>(levels_.size()); }
  double resolution() const { return params_.resolution; }
  const Eigen::Vector2d& origin() const { return origin_; }
  /// 0 to 255: the most that level 0 has in the 2^level cells from (x, y) on along both axes.
  int at(int level, int x, int y) const {
    const int pad = (1 << level) - 1;
    const unsigned column = static_cast<unsigned>(x + pad), row = static_cast<unsigned>(y + pad);
    const Level& l = levels_[static_cast<std::size_t>(level)];
    if (column >= static_cast<unsigned>(l.width) || row >= static_cast<unsigned>(l.height))
      return 0;
    return l.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(l.width) + column];
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> values;
  };
  Params params_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::vector<Level> levels_;
};

/// Where a scan fits best into a field, of all poses in a window: exhaustive, by branch and bound
/// over resolutions (Olson, Real-Time Correlative Scan Matching, 2009; Hess et al. 2016, section
/// V).
struct SearchWindow {
  double distance = 0.5;  ///< to either side of the guess along x and y [m]
  double angle = 0.35;    ///< to either side of the guess [rad]
  double least_score = 0.3;
  /// What the score loses at the rim of the window, quadratically from the guess. Decides between
  /// places that look the same.
  double distance_penalty = 0.05;
  double angle_penalty = 0.05;
};
struct CorrelativeMatch {
  Pose2 pose;          ///< of the scan's frame
  double score = 0.0;  ///< 0 to 1: mean likelihood of the points
};
std::optional<CorrelativeMatch> find_best_match(const LikelihoodField& field,
                                                const std::vector<Eigen::Vector2d>& points,
                                                const Pose2& guess, const SearchWindow& window);

}  // namespace swiftlet
