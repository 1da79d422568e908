// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "planner/path/path_planner.hpp"
#include "planner/path/path_smoothing.hpp"

namespace swiftlet::bench {

/// The path planning of the multi-sensor MAV (seed 004, Path Planning, steps 1 to 4 and 6, figures
/// 11 to 13): what PathPlanner is compared with.
///
///  1. A straight line to the goal.
///  2. Where an obstacle is in the way, a waypoint to the left or to the right of it, on the side
///     that is more open.
///  3. A waypoint in the centre of every bottleneck.
///  4. Again, for each leg of the path that this gives.
///
/// The paper says no more. So that it is a rule, here:
///  - In the way is what is nearer to the leg than the hard clearance, at every half cell.
///  - Left and right are along the face that the leg runs into, from the middle of the part that is
///    too near: along a wall to its next doorway, however slanting the leg. Where the leg only
///    grazes a face they are square to the leg.
///  - The waypoint is in the first gap on that side: in the middle of one that is a bottleneck,
///    else where the preferred clearance is kept from the obstacle.
///  - A side is as open as the share of a half disc of 1 m on it that the vehicle could be in. What
///    is unknown is not open and gets no waypoint, else ways would lead through the outer walls.
///    The width of the gap, and half discs of 2 and 4 m, solved fewer problems.
///  - A bottleneck is where two obstacles leave less room than twice the preferred clearance. Its
///    centre is the middle of the narrowest of 16 lines across it. It is added last, to free legs
///    that stay free, and not within 0.5 m of another waypoint.
///  - It gives up after 30 points, where neither side has a gap, and where a new waypoint is at an
///    end of the leg already. It never takes a waypoint back: that would be another planner, a
///    search.
class LeftRightRule {
 public:
  explicit LeftRightRule(const ClearanceMap& map)
      : map_(map),
        step_(0.5 * map.resolution()),
        aside_(std::max(0.0, map.cost().preferred_clearance - map.cost().hard_clearance())) {}

  std::optional<Path> plan(const Eigen::Vector2d& start, const Eigen::Vector2d& goal) const {
    if (!is_clear(start) || !is_clear(goal)) return std::nullopt;
    Polyline line{start, goal};
    for (std::size_t leg = 0; leg + 1 < line.size();) {
      const Eigen::Vector2d a = line[leg], b = line[leg + 1];
      const std::optional<Span> obstacle = first_obstacle(a, b);
      if (!obstacle) {
        ++leg;
        continue;
      }
      const std::optional<Eigen::Vector2d> waypoint = beside(a, b, *obstacle);
      if (!waypoint || line.size() >= kMostPoints || same(*waypoint, a) || same(*waypoint, b)) {
        return std::nullopt;
      }
      insert(line, leg, *waypoint);
    }
    center_in_bottlenecks(line);
    return to_path(std::move(line));
  }

 private:
  static constexpr std::size_t kMostPoints = 30;
  static constexpr double kOpenRadius = 1.0;  // of the half disc on a side [m]
  static constexpr double kGrazing = 0.2;     // sine of the angle between leg and face
  static constexpr int kLinesAcross = 16;
  static constexpr double kBottleneckSpacing = 0.5;  // of its centre from other waypoints [m]
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kPi = 3.14159265358979323846;

  /// From and to so far along a line [m].
  struct Span {
    double from, to;
    double middle() const { return 0.5 * (from + to); }
  };

  bool is_clear(const Eigen::Vector2d& p) const {
    return map_.clearance_at(p) >= map_.cost().hard_clearance();
  }
  bool is_open(const Eigen::Vector2d& p) const { return is_clear(p) && !map_.unknown_at(p); }
  bool same(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return (a - b).norm() < step_;
  }
  static void insert(Polyline& line, std::size_t leg, const Eigen::Vector2d& point) {
    line.insert(line.begin() + static_cast<std::ptrdiff_t>(leg) + 1, point);
  }

  /// The first part of a leg that is too near to something.
  std::optional<Span> first_obstacle(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const double length = (b - a).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / step_)));
    const auto clear = [&](int i) { return is_clear(a + (b - a) * (1.0 * i / steps)); };
    int first = 0;
    while (first <= steps && clear(first)) ++first;
    if (first > steps) return std::nullopt;
    int last = first;
    while (last < steps && !clear(last)) ++last;
    return Span{length * first / steps, length * last / steps};
  }

  /// Step 2: the waypoint on the more open side.
  std::optional<Eigen::Vector2d> beside(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                        const Span& obstacle) const {
    const Eigen::Vector2d ahead = (b - a).normalized();
    const Eigen::Vector2d middle = a + obstacle.middle() * ahead;
    const Eigen::Vector2d left = left_along_face(a + obstacle.from * ahead, ahead);
    std::optional<Eigen::Vector2d> best;
    int most_open = -1;
    for (const Eigen::Vector2d& side : {left, Eigen::Vector2d(-left)}) {
      const std::optional<Span> gap = first_gap(middle, side);
      if (!gap) continue;
      const int open = openness(middle, side);
      if (open <= most_open) continue;
      most_open = open;
      best = middle + side * std::min(gap->middle(), gap->from + aside_);
    }
    return best;
  }

  /// To the left along the face of the obstacle that a leg runs into at `contact`.
  Eigen::Vector2d left_along_face(const Eigen::Vector2d& contact,
                                  const Eigen::Vector2d& ahead) const {
    Eigen::Vector2d left(-ahead.y(), ahead.x());
    const auto slope = [&](const Eigen::Vector2d& d) {
      return map_.clearance_at(contact + d) - map_.clearance_at(contact - d);
    };
    const Eigen::Vector2d along(-slope({0.0, 2.0 * step_}), slope({2.0 * step_, 0.0}));
    const double leftward = along.dot(left);
    if (std::abs(leftward) <= kGrazing * along.norm()) return left;
    return along.normalized() * std::copysign(1.0, leftward);
  }

  /// The first open part of a ray.
  std::optional<Span> first_gap(const Eigen::Vector2d& from, const Eigen::Vector2d& side) const {
    double s = 0.0;
    while (!is_open(from + s * side)) {
      if (!map_.contains(Eigen::Vector2d(from + s * side))) return std::nullopt;
      s += step_;
    }
    return Span{s, s + open_ahead(from + s * side, side, kInfinity)};
  }

  /// How far it stays open in a direction, `most` at most [m].
  double open_ahead(const Eigen::Vector2d& from, const Eigen::Vector2d& direction,
                    double most) const {
    double s = 0.0;
    while (s < most && is_open(from + (s + step_) * direction)) s += step_;
    return s;
  }

  /// Number of open places in the half disc on a side.
  int openness(const Eigen::Vector2d& middle, const Eigen::Vector2d& side) const {
    const Eigen::Vector2d across(-side.y(), side.x());
    const double spacing = 2.0 * map_.resolution();
    const int reach = static_cast<int>(kOpenRadius / spacing);
    int open = 0;
    for (int x = 0; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        const Eigen::Vector2d off = spacing * (x * side + y * across);
        open += off.norm() < kOpenRadius && is_open(middle + off);
      }
    }
    return open;
  }

  /// Step 3, for every leg, and for the legs that this makes of it.
  void center_in_bottlenecks(Polyline& line) const {
    for (std::size_t leg = 0; leg + 1 < line.size();) {
      const std::optional<Eigen::Vector2d> center = bottleneck_between(line[leg], line[leg + 1]);
      if (center && line.size() < kMostPoints) {
        insert(line, leg, *center);
      } else {
        ++leg;
      }
    }
  }

  /// Centre of the tightest bottleneck of a free leg, where the leg can go through it.
  std::optional<Eigen::Vector2d> bottleneck_between(const Eigen::Vector2d& a,
                                                    const Eigen::Vector2d& b) const {
    const int steps = static_cast<int>(std::ceil((b - a).norm() / map_.resolution()));
    double least = map_.cost().preferred_clearance;
    std::optional<Eigen::Vector2d> tightest;
    for (int i = 1; i < steps; ++i) {
      const Eigen::Vector2d p = a + (b - a) * (1.0 * i / steps);
      const double clearance = map_.clearance_at(p);
      if (clearance >= least) continue;
      const std::optional<Eigen::Vector2d> center = bottleneck_center(p);
      if (!center || !fits(a, *center, b)) continue;
      tightest = center;
      least = clearance;
    }
    return tightest;
  }

  bool fits(const Eigen::Vector2d& a, const Eigen::Vector2d& center,
            const Eigen::Vector2d& b) const {
    return (center - a).norm() > kBottleneckSpacing && (center - b).norm() > kBottleneckSpacing &&
           !first_obstacle(a, center) && !first_obstacle(center, b);
  }

  /// Nothing where there is room enough.
  std::optional<Eigen::Vector2d> bottleneck_center(const Eigen::Vector2d& p) const {
    double narrowest = 2.0 * aside_;
    std::optional<Eigen::Vector2d> center;
    for (int i = 0; i < kLinesAcross; ++i) {
      const double angle = kPi * i / kLinesAcross;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const double one = open_ahead(p, direction, narrowest);
      const double other = open_ahead(p, -direction, narrowest);
      if (one + other >= narrowest) continue;
      narrowest = one + other;
      center = p + 0.5 * (one - other) * direction;
    }
    return center;
  }

  Path to_path(Polyline line) const {
    Path path;
    path.cost = polyline_cost(map_, line);
    for (std::size_t i = 1; i < line.size(); ++i) path.length += (line[i] - line[i - 1]).norm();
    path.points = std::move(line);
    return path;
  }

  const ClearanceMap& map_;
  double step_;   // [m]
  double aside_;  // of the hard clearance's edge, to keep the preferred clearance [m]
};

/// Nothing where the rule gives up.
inline std::optional<Path> left_right_path(const ClearanceMap& map, const Eigen::Vector2d& start,
                                           const Eigen::Vector2d& goal) {
  return LeftRightRule(map).plan(start, goal);
}

}  // namespace swiftlet::bench
