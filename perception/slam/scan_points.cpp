// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/scan_points.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr int kMaxNeighbours = 12;      // to either side
constexpr double kMaxGap = 0.35;        // between neighbours of one surface [m]
constexpr double kGrazing = 4.0;        // times the spacing of beams that meet a wall upright
constexpr double kMaxRoughness = 0.04;  // second principal value to first of what is a line
constexpr int kLeastPoints = 3;

/// Unit normal of the line through points[from..to], towards the origin; zero where it is none.
Vector2d fit_normal(const std::vector<Vector2d>& points, std::size_t from, std::size_t to) {
  const double count = static_cast<double>(to - from + 1);
  if (to - from + 1 < kLeastPoints) return Vector2d::Zero();
  Vector2d mean = Vector2d::Zero();
  for (std::size_t i = from; i <= to; ++i) mean += points[i];
  mean /= count;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = from; i <= to; ++i) {
    const Vector2d d = points[i] - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  const double half_difference = std::hypot(0.5 * (xx - yy), xy);
  const double most = 0.5 * (xx + yy) + half_difference, least = 0.5 * (xx + yy) - half_difference;
  if (!(most > 0.0) || least > kMaxRoughness * most) return Vector2d::Zero();
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const Vector2d normal(-std::sin(direction), std::cos(direction));
  return normal.dot(mean) > 0.0 ? Vector2d(-normal) : normal;
}

/// Returns in the order of the beams, and which of them begin a surface: the one before ended
/// elsewhere. The first one does.
struct Surfaces {
  std::vector<Vector2d> points;
  std::vector<bool> starts;
};

Surfaces surfaces_of(const LaserScan& scan, const std::vector<LevelledReturn>& returns) {
  Surfaces surfaces;
  surfaces.points.reserve(returns.size());
  surfaces.starts.reserve(returns.size());
  const LevelledReturn* last = nullptr;
  for (const LevelledReturn& now : returns) {
    bool start = last == nullptr;
    if (!start) {
      const double turned =
          std::abs(scan.angle_increment) * static_cast<double>(now.beam - last->beam);
      const double upright = std::min(now.range, last->range) * turned;
      start = (now.position - last->position).norm() > std::max(kMaxGap, kGrazing * upright);
    }
    surfaces.points.push_back(now.position);
    surfaces.starts.push_back(start);
    last = &now;
  }
  return surfaces;
}

}  // namespace

ScanPoints scan_points(const LaserScan& scan, const ScannerMotion& motion,
                       const ScanPointsParams& params) {
  const Surfaces surfaces = surfaces_of(scan, levelled_returns(scan, motion, params.max_range));
  const std::vector<Vector2d>& points = surfaces.points;
  ScanPoints result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool follows = !result.empty() && !surfaces.starts[i];
    if (follows && (points[i] - result.back().position).norm() < params.spacing) continue;
    const auto is_neighbour = [&](std::size_t other, int steps) {
      return steps == 1 || (points[other] - points[i]).norm() <= params.normal_radius;
    };
    std::size_t from = i, to = i;
    for (int n = 1; n <= kMaxNeighbours && !surfaces.starts[from] && is_neighbour(from - 1, n); ++n)
      --from;
    for (int n = 1; n <= kMaxNeighbours && to + 1 < points.size() && !surfaces.starts[to + 1] &&
                    is_neighbour(to + 1, n);
         ++n)
      ++to;
    result.push_back({points[i], fit_normal(points, from, to)});
  }
  return result;
}

}  // namespace swiftlet
