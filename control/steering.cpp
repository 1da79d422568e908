// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/steering.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace swiftlet {
namespace {

using Eigen::Vector3d;

// Gains of the chain: all three poles at kPole [1/s].
constexpr double kPole = 8.0;
constexpr double kVelocityGain = kPole / 3.0;
constexpr double kAccelerationGain = kPole;
constexpr double kJerkGain = 3.0 * kPole;
// Two poles at kYawPole [1/s].
constexpr double kYawPole = 8.0;
constexpr double kRateGain = kYawPole / 2.0;
constexpr double kYawAccelerationGain = 2.0 * kYawPole;
/// Of the jerk that is allowed, so much brings the acceleration down again: the rest is for what
/// the chain is late.
constexpr double kJerkShare = 0.5;

Vector3d bounded(const Vector3d& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Vector3d(v * (limit / norm)) : v;
}

/// How much a stick that is so far from its centre asks for, from 0 to 1.
double asked(double deflection, double dead_band) {
  return std::clamp((deflection - dead_band) / (1.0 - dead_band), 0.0, 1.0);
}

}  // namespace

double Sticks::deflection() const {
  const double sum = forward + left + up + turn;
  if (std::isnan(sum)) return sum;
  return std::max({std::abs(forward), std::abs(left), std::abs(up), std::abs(turn)});
}

bool SteeringLimits::usable() const {
  const double all[] = {speed, climb_speed, turn_rate,        acceleration,
                        jerk,  snap,        yaw_acceleration, yaw_jerk};
  return dead_band >= 0.0 && dead_band <= 0.5 &&
         std::all_of(std::begin(all), std::end(all),
                     [](double v) { return v >= 1e-3 && v <= 1e4; });
}

double easing(double error, double gain, double slope) {
  const double size = std::abs(error);
  const double join = slope / (gain * gain);
  const double rate = size <= join ? gain * size : std::sqrt(2.0 * slope * (size - 0.5 * join));
  return std::copysign(rate, error);
}

Steering steering(const Sticks& sticks, double yaw, const SteeringLimits& limits) {
  const auto asks = [&limits](double stick) {
    return std::copysign(asked(std::abs(stick), limits.dead_band), stick);
  };
  // The dead band is a disc, so that the vehicle goes where the stick points.
  const Eigen::Vector2d level(sticks.forward, sticks.left);
  const double size = level.norm();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  if (size > limits.dead_band) {
    velocity =
        Eigen::Rotation2Dd(yaw) * level * (asked(size, limits.dead_band) * limits.speed / size);
  }
  return {{velocity.x(), velocity.y(), asks(sticks.up) * limits.climb_speed},
          asks(sticks.turn) * limits.turn_rate};
}

Trajectory steer(Time now, Duration lasting, const FlatReference& from, const Steering& wanted,
                 const SteeringLimits& limits, const ReferenceLimits& braking) {
  const double dt = to_seconds(lasting);
  if (!wanted.velocity.allFinite() || !std::isfinite(wanted.yaw_rate)) return {};
  const Vector3d error = wanted.velocity - from.velocity;
  const double size = error.norm();
  Vector3d acceleration = Vector3d::Zero();
  if (size > 0.0) {
    const double rate = easing(size, kVelocityGain, kJerkShare * limits.jerk);
    acceleration = error * (std::min(rate, limits.acceleration) / size);
  }
  const Vector3d jerk =
      bounded((acceleration - from.acceleration) * kAccelerationGain, limits.jerk);
  const Vector3d snap = bounded((jerk - from.jerk) * kJerkGain, limits.snap);

  const double yaw_acceleration = std::clamp((wanted.yaw_rate - from.yaw_rate) * kRateGain,
                                             -limits.yaw_acceleration, limits.yaw_acceleration);
  const double yaw_jerk =
      std::clamp((yaw_acceleration - from.yaw_acceleration) * kYawAccelerationGain,
                 -limits.yaw_jerk, limits.yaw_jerk);

  TrajectorySegment segment;
  segment.duration_s = dt;
  for (int axis = 0; axis < 3; ++axis) {
    segment.coefficients[static_cast<std::size_t>(axis)].head<5>() << from.position[axis],
        from.velocity[axis] * dt, from.acceleration[axis] * dt * dt / 2.0,
        from.jerk[axis] * std::pow(dt, 3) / 6.0, snap[axis] * std::pow(dt, 4) / 24.0;
  }
  segment.coefficients[kYaw].head<4>() << from.yaw, from.yaw_rate * dt,
      from.yaw_acceleration * dt * dt / 2.0, yaw_jerk * std::pow(dt, 3) / 6.0;

  const Trajectory piece(now, {segment});
  if (piece.empty()) return {};
  const auto brake = FlightReference::brake(piece.end(), piece.evaluate(piece.end()), braking);
  if (!brake.ok()) return {};
  std::vector<TrajectorySegment> segments{segment};
  const Trajectory stop = brake->trajectory();
  segments.insert(segments.end(), stop.segments().begin(), stop.segments().end());
  return {now, std::move(segments)};
}

}  // namespace swiftlet
