// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/durations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

// A step must lower the cost by this share of what its slope promises (Armijo), and is halved so
// often at most until it does.
constexpr double kArmijo = 1e-4;
constexpr int kHalvings = 30;
// No step changes a duration by more than a factor of about e^1.
constexpr double kLongestStep = 1.0;
// Who moves by less has nothing to fly, and rounding decides on the cost [m].
constexpr double kNoWay = 1e-6;
// The cost of 1 m in 1 s, from rest to rest.
constexpr double kUnitCost = 100800.0;

/// Time to cover a distance from one speed to another, within limits of speed and acceleration.
double trapezoid_s(double distance, double v0, double v1, double v_max, double a_max) {
  const double peak =
      std::min(v_max, std::sqrt(std::max(0.0, a_max * distance + 0.5 * (v0 * v0 + v1 * v1))));
  const double ramps = std::max(0.0, 2 * peak * peak - v0 * v0 - v1 * v1) / (2 * a_max);
  const double cruise = std::max(0.0, distance - ramps) / std::max(peak, 1e-6);
  return std::max(0.0, 2 * peak - v0 - v1) / a_max + cruise;
}

std::vector<double> scaled(std::vector<double> durations, double total_s) {
  const double sum = std::accumulate(durations.begin(), durations.end(), 0.0);
  for (double& duration : durations) duration *= total_s / sum;
  return durations;
}

/// The search for the durations: over one number z a piece, with the durations
/// floor + room * exp(z_i) / sum exp(z_k), so that their sum and their least hold by construction.
class LeastSnap {
 public:
  LeastSnap(const FlatReference& start, const std::vector<Waypoint>& waypoints, double total_s,
            const LeastSnapParams& params)
      : start_(start), waypoints_(waypoints), params_(params) {
    const auto n = static_cast<double>(waypoints.size());
    floor_s_ = params.least_share * total_s / n;
    room_s_ = total_s - floor_s_ * n;
    no_cost_ = kUnitCost * kNoWay * kNoWay / std::pow(total_s, 7);
  }

  struct Point {
    Eigen::VectorXd z;
    std::vector<double> durations;
    double cost = 0.0;         // snap_cost()
    Eigen::VectorXd gradient;  // of log(cost) by z
  };

  /// Fails where the durations have no solution.
  Result<Point> at(const Eigen::VectorXd& z) const {
    Point point;
    point.z = z.array() - z.maxCoeff();
    Eigen::VectorXd share = point.z.array().exp();
    share /= share.sum();
    for (const double s : share) point.durations.push_back(floor_s_ + room_s_ * s);
    const auto minimum = minimum_snap(Time{}, start_, waypoints_, point.durations);
    if (!minimum) return minimum.error();
    point.cost = snap_cost(*minimum, params_.yaw_weight);
    const std::vector<double> slopes = snap_cost_slopes(*minimum, params_.yaw_weight);
    const Eigen::Map<const Eigen::VectorXd> slope(slopes.data(), z.size());
    // Durations move by room share_i (dz_i - sum_k share_k dz_k).
    point.gradient =
        room_s_ / std::max(point.cost, 1e-300) * share.array() * (slope.array() - share.dot(slope));
    return point;
  }

  Result<Point> at(const std::vector<double>& durations) const {
    Eigen::VectorXd z(static_cast<Eigen::Index>(durations.size()));
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double over = durations[static_cast<std::size_t>(i)] - floor_s_;
      z[i] = std::log(std::max(over, 1e-3 * floor_s_) / room_s_);
    }
    return at(z);
  }

  /// Downhill from a point, until the tolerance or the bound on work.
  Point descend(Point point) const {
    double step = 0.1;
    for (int k = 0; k < params_.max_iterations; ++k) {
      const double steepest = point.gradient.lpNorm<Eigen::Infinity>();
      if (!(point.cost > no_cost_) || !(steepest > params_.tolerance)) break;
      step = std::min(step, kLongestStep / steepest);
      std::optional<Point> next;
      for (int halving = 0; halving < kHalvings && !next; ++halving, step *= 0.5) {
        Result<Point> tried = at(Eigen::VectorXd(point.z - step * point.gradient));
        const double promised = kArmijo * step * point.gradient.squaredNorm();
        if (tried && std::log(tried->cost) <= std::log(point.cost) - promised) next = *tried;
      }
      if (!next) break;
      const Eigen::VectorXd moved = next->z - point.z;
      const Eigen::VectorXd turned = next->gradient - point.gradient;
      const double curvature = moved.dot(turned);
      step = curvature > 0.0 ? moved.squaredNorm() / curvature : kLongestStep / steepest;
      point = *std::move(next);
    }
    return point;
  }

 private:
  const FlatReference& start_;
  const std::vector<Waypoint>& waypoints_;
  const LeastSnapParams& params_;
  double floor_s_ = 0.0, room_s_ = 0.0;
  double no_cost_ = 0.0;  // below which there is nothing to fly
};

}  // namespace

std::vector<double> trapezoid_durations(const FlatReference& start,
                                        const std::vector<Waypoint>& waypoints,
                                        const SpeedProfile& profile) {
  const std::size_t n = waypoints.size();
  const double v_max = profile.max_speed;
  // Smooth ramps peak at about twice the acceleration of straight ones.
  const double a_max = 0.5 * profile.max_acceleration;
  std::vector<Eigen::Vector3d> points{start.position};
  for (const Waypoint& waypoint : waypoints) points.push_back(waypoint.position);
  std::vector<double> speed(n + 1, 0.0), distance(n);
  for (std::size_t i = 0; i < n; ++i) distance[i] = (points[i + 1] - points[i]).norm();
  speed[0] = std::min(start.velocity.norm(), v_max);
  for (std::size_t i = 1; i < n; ++i) {
    // What the turn allows: a circle that touches both legs as far out as the shorter one reaches.
    const Eigen::Vector3d in = points[i] - points[i - 1], out = points[i + 1] - points[i];
    const double turn = std::atan2(in.cross(out).norm(), in.dot(out));
    const double radius =
        0.5 * std::min(distance[i - 1], distance[i]) / std::max(std::tan(0.5 * turn), 1e-6);
    speed[i] = std::clamp(std::sqrt(a_max * radius), 0.1 * v_max, v_max);
  }
  for (std::size_t i = 1; i <= n; ++i) {
    if (waypoints[i - 1].velocity) {
      speed[i] = std::min(waypoints[i - 1].velocity->norm(), v_max);
    }
  }
  for (std::size_t i = 1; i <= n; ++i) {
    speed[i] =
        std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * a_max * distance[i - 1]));
  }
  for (std::size_t i = n; i > 1; --i) {
    speed[i - 1] =
        std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + 2 * a_max * distance[i - 1]));
  }
  std::vector<double> durations(n);
  double yaw = start.yaw;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = std::abs(wrap_angle(waypoints[i].yaw - yaw));
    yaw = waypoints[i].yaw;
    durations[i] = std::max({profile.min_duration_s, 1.5 * turn / profile.yaw_rate,
                             trapezoid_s(distance[i], speed[i], speed[i + 1], v_max, a_max)});
  }
  return durations;
}

std::vector<double> snap_cost_slopes(const Trajectory& minimum, double yaw_weight) {
  std::vector<double> slopes;
  for (const TrajectorySegment& segment : minimum.segments()) {
    double slope = 0.0;
    for (int axis = kX; axis <= kYaw; ++axis) {
      const auto d = [&](int order) { return derivative(segment, axis, 0.0, order); };
      slope += (axis == kYaw ? yaw_weight : 1.0) *
               (-d(4) * d(4) + 2 * d(5) * d(3) - 2 * d(6) * d(2) + 2 * d(7) * d(1));
    }
    slopes.push_back(slope);
  }
  return slopes;
}

Result<std::vector<double>> least_snap_durations(const FlatReference& start,
                                                 const std::vector<Waypoint>& waypoints,
                                                 double total_s, const LeastSnapParams& params) {
  const std::vector<double> equal(waypoints.size(),
                                  total_s / static_cast<double>(waypoints.size()));
  // Solving once checks all that is given.
  if (const auto checked = minimum_snap(Time{}, start, waypoints, equal); !checked) {
    return checked.error();
  }
  const LeastSnap search(start, waypoints, total_s, params);
  const auto from_equal = search.at(equal);
  if (!from_equal) return from_equal.error();
  const auto from_trapezoid =
      search.at(scaled(trapezoid_durations(start, waypoints, SpeedProfile()), total_s));
  const bool equal_is_better = !from_trapezoid || from_equal->cost <= from_trapezoid->cost;
  return search.descend(equal_is_better ? *from_equal : *from_trapezoid).durations;
}

}  // namespace swiftlet
