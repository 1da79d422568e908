// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/any_angle/taut_line.hpp"

#include <algorithm>
#include <limits>

namespace swiftlet {
namespace {

constexpr int kMostRounds = 20;
constexpr double kLeastGain = 1e-4;  // of the length, for another round
constexpr double kFirstStep = 0.5;   // [voxels]
constexpr double kLeastCut = 0.1;    // of a corner [voxels]
constexpr std::size_t kReach = 24;   // points that are looked ahead for a shortcut

/// The shortest line through some of the points, first and last included.
SpaceLine shortcut(const VoxelGrid& grid, const SpaceLine& line) {
  std::vector<double> length(line.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> next(line.size(), 0);
  length.back() = 0.0;
  for (std::size_t i = line.size() - 1; i-- > 0;) {
    const std::size_t last = std::min(line.size() - 1, i + kReach);
    for (std::size_t k = i + 1; k <= last; ++k) {
      const double through = (line[k] - line[i]).norm() + length[k];
      if (through >= length[i]) continue;
      if (k > i + 1 && !line_is_free(grid, line[i], line[k])) continue;
      length[i] = through;
      next[i] = k;
    }
  }
  SpaceLine result{line.front()};
  for (std::size_t i = 0; i + 1 < line.size();) {
    i = next[i];
    result.push_back(line[i]);
  }
  return result;
}

/// Moves a point by a step to the neighbour that makes the line through it shortest, while there
/// is one.
bool move_point(const VoxelGrid& grid, SpaceLine& line, std::size_t i, double step) {
  const Eigen::Vector3d &before = line[i - 1], &after = line[i + 1];
  bool moved = false;
  for (;;) {
    Eigen::Vector3d best = line[i];
    double least = (best - before).norm() + (after - best).norm();
    for (int direction = 0; direction < 27; ++direction) {
      const Eigen::Vector3d by(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
      const Eigen::Vector3d point = line[i] + step * by;
      const double length = (point - before).norm() + (after - point).norm();
      constexpr double kNoise = 1e-9;
      if (length > least - kNoise || !line_is_free(grid, before, point) ||
          !line_is_free(grid, point, after)) {
        continue;
      }
      least = length;
      best = point;
    }
    if (best == line[i]) return moved;
    line[i] = best;
    moved = true;
  }
}

/// Cuts each corner off, as far from it as half the shorter of its legs, or a part of that: one
/// turn may be that around two obstacles, which takes two points.
SpaceLine cut_corners(const VoxelGrid& grid, const SpaceLine& line) {
  SpaceLine result{line.front()};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d to_last = result.back() - line[i], to_next = line[i + 1] - line[i];
    double reach = 0.5 * std::min(to_last.norm(), to_next.norm());
    Eigen::Vector3d first, second;
    for (; reach >= kLeastCut; reach *= 0.5) {
      first = line[i] + reach * to_last.normalized();
      second = line[i] + reach * to_next.normalized();
      if (line_is_free(grid, first, second)) break;
    }
    if (reach >= kLeastCut) {
      result.push_back(first);
      result.push_back(second);
    } else {
      result.push_back(line[i]);
    }
  }
  result.push_back(line.back());
  return result;
}

}  // namespace

double length_of(const SpaceLine& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

bool line_is_free(const VoxelGrid& grid, const SpaceLine& line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (!line_is_free(grid, line[i - 1], line[i])) return false;
  }
  return true;
}

SpaceLine pull_taut(const VoxelGrid& grid, SpaceLine line, const Stop& stop, double finest) {
  if (line.size() < 3) return line;
  double before = length_of(line);
  for (int round = 0; round < kMostRounds && !stop(); ++round) {
    line = shortcut(grid, cut_corners(grid, line));
    for (double step = kFirstStep; step >= finest; step *= 0.5) {
      for (std::size_t i = 1; i + 1 < line.size() && !stop(); ++i) {
        move_point(grid, line, i, step);
      }
    }
    const double now = length_of(line);
    if (now > before * (1.0 - kLeastGain) || stop()) break;
    before = now;
  }
  return line;
}

}  // namespace swiftlet
