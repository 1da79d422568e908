// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "planner/trajectory/body_rate.hpp"

namespace swiftlet {
namespace {

/// Stretching aims at no less than this of what a piece has, and at no more: the body rate of a
/// piece that falls freely is infinite, which says little about how long it should be.
constexpr double kLeastStretch = 1e-3;
constexpr double kMostStretch = 10.0;
/// Moments of a piece at which the stretch for its thrust is looked for; what is near enough to go
/// by the bound alone; and the share of what that says which is needed at least, if the moments
/// have missed the one that counts.
constexpr int kMoments = 16;
constexpr double kNear = 1.05;
constexpr double kSurelyNeeded = 0.25;

/// |a + g e3|^2 over the segment.
SquarePolynomial squared_thrust(const TrajectorySegment& segment) {
  SquarePolynomial square = SquarePolynomial::Zero();
  for (std::size_t axis = kX; axis <= kZ; ++axis) {
    Polynomial force =
        differentiate(segment.coefficients[axis], 2) / (segment.duration_s * segment.duration_s);
    if (axis == kZ) force[0] += kGravity;
    add_square(force, square);
  }
  return square;
}

double max_yaw_rate(const TrajectorySegment& segment) {
  const Polynomial rate = differentiate(segment.coefficients[kYaw]);
  return std::max(upper_bound(rate), -lower_bound(rate)) / segment.duration_s;
}

/// Which of the extrema are to be found; the others are as in a hover.
struct Wanted {
  bool max_thrust = true, min_thrust = true, body_rate = true, yaw_rate = true;
};

Wanted limited(const TrajectoryLimits& limits) {
  return {std::isfinite(limits.max_thrust_per_mass), limits.min_thrust_per_mass > 0.0,
          std::isfinite(limits.max_body_rate), std::isfinite(limits.max_yaw_rate)};
}

TrajectoryExtrema find(const TrajectorySegment& segment, const Wanted& wanted) {
  TrajectoryExtrema found;
  found.max_speed = max_derivative_norm(segment, 1);
  found.max_acceleration = max_derivative_norm(segment, 2);
  if (wanted.max_thrust || wanted.min_thrust) {
    const SquarePolynomial square = squared_thrust(segment);
    if (wanted.max_thrust) found.max_thrust_per_mass = std::sqrt(upper_bound(square));
    if (wanted.min_thrust) {
      found.min_thrust_per_mass = std::sqrt(std::max(0.0, lower_bound(square)));
    }
  }
  if (wanted.body_rate) found.max_body_rate = max_body_rate(segment);
  if (wanted.yaw_rate) found.max_yaw_rate = max_yaw_rate(segment);
  return found;
}

void join(TrajectoryExtrema& all, const TrajectoryExtrema& one) {
  all.max_speed = std::max(all.max_speed, one.max_speed);
  all.max_acceleration = std::max(all.max_acceleration, one.max_acceleration);
  all.max_thrust_per_mass = std::max(all.max_thrust_per_mass, one.max_thrust_per_mass);
  all.min_thrust_per_mass = std::min(all.min_thrust_per_mass, one.min_thrust_per_mass);
  all.max_body_rate = std::max(all.max_body_rate, one.max_body_rate);
  all.max_yaw_rate = std::max(all.max_yaw_rate, one.max_yaw_rate);
}

/// The share of each limit's room that is used.
struct Usage {
  double speed, acceleration, max_thrust, min_thrust, body_rate, yaw_rate;
};

Usage usages(const TrajectoryExtrema& e, const TrajectoryLimits& limits) {
  return {e.max_speed / limits.max_speed,
          e.max_acceleration / limits.max_acceleration,
          (e.max_thrust_per_mass - kGravity) / (limits.max_thrust_per_mass - kGravity),
          (kGravity - e.min_thrust_per_mass) / (kGravity - limits.min_thrust_per_mass),
          e.max_body_rate / limits.max_body_rate,
          e.max_yaw_rate / limits.max_yaw_rate};
}

bool keeps(const TrajectoryExtrema& e, const TrajectoryLimits& limits) {
  return e.max_speed <= limits.max_speed && e.max_acceleration <= limits.max_acceleration &&
         e.max_thrust_per_mass <= limits.max_thrust_per_mass &&
         e.min_thrust_per_mass >= limits.min_thrust_per_mass &&
         e.max_body_rate <= limits.max_body_rate && e.max_yaw_rate <= limits.max_yaw_rate;
}

/// By how much a piece would have to last longer for its thrust, by the moments that are looked at:
/// the largest root y of |g e3 + a / y|^2 = limit^2, where y is the square of the stretch.
double thrust_stretch_of_moments(const TrajectorySegment& segment, const TrajectoryLimits& limits) {
  const double most = limits.max_thrust_per_mass * limits.max_thrust_per_mass;
  const double least = limits.min_thrust_per_mass * limits.min_thrust_per_mass;
  constexpr double kHover = kGravity * kGravity;
  double y = 0.0;
  for (int i = 0; i <= kMoments; ++i) {
    const double s = static_cast<double>(i) / kMoments;
    const Eigen::Vector3d a(derivative(segment, kX, s, 2), derivative(segment, kY, s, 2),
                            derivative(segment, kZ, s, 2));
    const double up = kGravity * a.z(), square = a.squaredNorm();
    if (std::isfinite(most)) {
      y = std::max(y, (up + std::sqrt(up * up + (most - kHover) * square)) / (most - kHover));
    }
    const double below = up * up - (kHover - least) * square;
    if (least > 0.0 && up < 0.0 && below > 0.0) {
      y = std::max(y, (-up + std::sqrt(below)) / (kHover - least));
    }
  }
  return std::sqrt(y);
}

/// The same, and more than 1 wherever a limit is broken.
double thrust_stretch(const TrajectorySegment& segment, const Usage& usage,
                      const TrajectoryLimits& limits) {
  // That is right near the limit, and too much far above it: a hover needs thrust, too.
  const double enough = std::sqrt(std::max({0.0, usage.max_thrust, usage.min_thrust}));
  if (enough == 0.0 || (enough >= 1.0 && enough <= kNear)) return enough;
  const double seen = thrust_stretch_of_moments(segment, limits);
  if (enough < 1.0) return seen;
  return std::clamp(seen, 1.0 + kSurelyNeeded * (enough - 1.0), enough);
}

}  // namespace

TrajectoryLimits share_of(const TrajectoryLimits& limits, double share) {
  TrajectoryLimits part;
  part.max_speed = share * limits.max_speed;
  part.max_acceleration = share * limits.max_acceleration;
  part.max_thrust_per_mass = kGravity + share * (limits.max_thrust_per_mass - kGravity);
  if (limits.min_thrust_per_mass > 0.0) {
    part.min_thrust_per_mass = kGravity - share * (kGravity - limits.min_thrust_per_mass);
  }
  part.max_body_rate = share * limits.max_body_rate;
  part.max_yaw_rate = share * limits.max_yaw_rate;
  return part;
}

Status check(const TrajectoryLimits& limits) {
  if (!(limits.max_speed > 0.0 && limits.max_acceleration > 0.0 && limits.max_body_rate > 0.0 &&
        limits.max_yaw_rate > 0.0)) {
    return Error{"the limits of the trajectory must be positive"};
  }
  if (!(limits.max_thrust_per_mass > kGravity && limits.min_thrust_per_mass < kGravity)) {
    return Error{fmt::format(
        "a hover takes {:.4g} m/s^2 of thrust per mass, which must be between the limits of {:.4g} "
        "and {:.4g}",
        kGravity, limits.min_thrust_per_mass, limits.max_thrust_per_mass)};
  }
  return {};
}

TrajectoryExtrema extrema(const TrajectorySegment& segment) {
  return find(segment, Wanted());
}

TrajectoryExtrema extrema(const Trajectory& trajectory) {
  TrajectoryExtrema all;
  for (const TrajectorySegment& segment : trajectory.segments()) join(all, extrema(segment));
  return all;
}

TrajectoryExtrema extrema(const FlatReference& reference) {
  TrajectoryExtrema values;
  values.max_speed = reference.velocity.norm();
  values.max_acceleration = reference.acceleration.norm();
  values.max_thrust_per_mass =
      (reference.acceleration + kGravity * Eigen::Vector3d::UnitZ()).norm();
  values.min_thrust_per_mass = values.max_thrust_per_mass;
  values.max_body_rate = body_rate(reference);
  values.max_yaw_rate = std::abs(reference.yaw_rate);
  return values;
}

double usage(const TrajectoryExtrema& extrema, const TrajectoryLimits& limits) {
  const Usage u = usages(extrema, limits);
  double most = std::max({u.speed, u.acceleration, u.max_thrust, u.body_rate, u.yaw_rate});
  if (limits.min_thrust_per_mass > 0.0) most = std::max(most, u.min_thrust);
  return most;
}

Status within(const TrajectoryExtrema& extrema, const TrajectoryLimits& limits) {
  if (keeps(extrema, limits)) return {};
  std::string broken;
  const auto name = [&](const char* what, double value, const char* side, double limit,
                        const char* unit) {
    broken += fmt::format("{}the {} {:.4g} {}, {} the limit of {:.4g} {}",
                          broken.empty() ? "" : "; ", what, value, unit, side, limit, unit);
  };
  const auto below = [&](const char* what, double value, double limit, const char* unit) {
    if (!(value <= limit)) name(what, value, "above", limit, unit);
  };
  below("speed reaches", extrema.max_speed, limits.max_speed, "m/s");
  below("acceleration reaches", extrema.max_acceleration, limits.max_acceleration, "m/s^2");
  below("thrust per mass reaches", extrema.max_thrust_per_mass, limits.max_thrust_per_mass,
        "m/s^2");
  if (!(extrema.min_thrust_per_mass >= limits.min_thrust_per_mass)) {
    name("thrust per mass falls to", extrema.min_thrust_per_mass, "below",
         limits.min_thrust_per_mass, "m/s^2");
  }
  below("body rate reaches", extrema.max_body_rate, limits.max_body_rate, "rad/s");
  below("yaw rate reaches", extrema.max_yaw_rate, limits.max_yaw_rate, "rad/s");
  return Error{broken};
}

Status within(const TrajectorySegment& segment, const TrajectoryLimits& limits) {
  return within(find(segment, limited(limits)), limits);
}

double needed_stretch(const TrajectorySegment& segment, const TrajectoryLimits& limits) {
  Wanted wanted = limited(limits);
  const bool body_rate = std::exchange(wanted.body_rate, false);
  TrajectoryExtrema found = find(segment, wanted);
  const Usage u = usages(found, limits);
  // Velocities go with 1 / time, acceleration and the thrust for it with the square, and the part
  // of the body rate that turns the thrust with the cube.
  double stretch = std::max({u.speed, std::sqrt(u.acceleration), thrust_stretch(segment, u, limits),
                             u.yaw_rate, kLeastStretch});
  if (body_rate) {
    // The dearest comes last, and only as well as it matters beside the others.
    found.max_body_rate = max_body_rate(segment, std::pow(stretch, 3) * limits.max_body_rate);
    stretch = std::max(stretch, std::cbrt(found.max_body_rate / limits.max_body_rate));
  }
  // Quotients are rounded.
  return keeps(found, limits) ? std::min(stretch, 1.0)
                              : std::clamp(stretch, 1.0 + std::numeric_limits<double>::epsilon(),
                                           std::max(kMostStretch, u.speed));
}

}  // namespace swiftlet
