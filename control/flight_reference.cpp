// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_reference.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// A ramp of velocity follows the smoothstep 10 s^3 - 15 s^4 + 6 s^5, whose first and second
// derivatives reach these values.
constexpr double kRampAcceleration = 15.0 / 8.0;
constexpr double kRampJerk = 5.773502691896258;  // 10 / sqrt(3)

// Where a request is this far away or this slow, something upstream is wrong.
constexpr double kMaxDistance = 1e5;    // [m]
constexpr double kMinLimit = 1e-3;      // in the unit of the limit
constexpr double kMaxLimit = 1e4;       // in the unit of the limit
constexpr double kMaxDerivative = 1e4;  // of a reference to brake from, in its unit
constexpr int kBrakeSamples = 64;
constexpr double kBrakeGrowth = 1.03;
constexpr int kBrakeIterations = 1000;

bool usable(const ReferenceLimits& limits) {
  const double all[] = {limits.velocity, limits.acceleration, limits.jerk, limits.yaw_acceleration,
                        limits.yaw_jerk};
  return std::all_of(std::begin(all), std::end(all),
                     [](double v) { return v >= kMinLimit && v <= kMaxLimit; });
}

bool usable(const Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= kMaxDistance;
}

Error bad_limits() {
  return Error{"reference limits must be positive and finite"};
}

Vector4d with_yaw(const Vector3d& position, double yaw) {
  return {position.x(), position.y(), position.z(), yaw};
}

/// Shape of a brake: velocity v(s) = v0 h0(s) + a0 T h1(s), s = t / T, that comes to rest with no
/// acceleration and no jerk. Coefficients of s^0 .. s^5.
constexpr std::array<double, 6> kH0{1, 0, 0, -10, 15, -6};
constexpr std::array<double, 6> kH1{0, 1, 0, -6, 8, -3};

double derivative(const std::array<double, 6>& h, int order, double s) {
  double value = 0.0;
  for (int k = 5; k >= order; --k) {
    double factor = 1.0;
    for (int i = 0; i < order; ++i) factor *= k - i;
    value = value * s + factor * h[static_cast<std::size_t>(k)];
  }
  return value;
}

/// Whether a brake of duration T keeps within the limits.
bool brake_within(const Vector3d& v0, const Vector3d& a0, double T, double max_acceleration,
                  double max_jerk) {
  for (int i = 0; i <= kBrakeSamples; ++i) {
    const double s = static_cast<double>(i) / kBrakeSamples;
    const Vector3d a = v0 / T * derivative(kH0, 1, s) + a0 * derivative(kH1, 1, s);
    const Vector3d j = v0 / (T * T) * derivative(kH0, 2, s) + a0 / T * derivative(kH1, 2, s);
    if (a.norm() > max_acceleration || j.norm() > max_jerk) return false;
  }
  return true;
}

/// Shortest duration (to 3 %) of a brake within the limits. Every long enough one is.
double brake_duration(const Vector3d& v0, const Vector3d& a0, double max_acceleration,
                      double max_jerk) {
  const double speed = v0.norm();
  const double acceleration = a0.norm();
  if (speed == 0.0 && acceleration == 0.0) return 0.0;
  const double allowed = std::max(max_acceleration, acceleration) * (1.0 + 1e-9);
  double T = std::max(1e-3, 0.3 * speed / allowed);
  for (int i = 0; i < kBrakeIterations && !brake_within(v0, a0, T, allowed, max_jerk); ++i) {
    T *= kBrakeGrowth;
  }
  return T;
}

}  // namespace

Result<FlightReference> FlightReference::hold(const Vector3d& position, double yaw) {
  if (!usable(position) || !std::isfinite(yaw)) return Error{"position or yaw is not usable"};
  FlightReference reference;
  reference.rest_ = with_yaw(position, yaw);
  return reference;
}

Result<FlightReference> FlightReference::move(Time start, const Vector3d& from, const Vector3d& to,
                                              double yaw, const ReferenceLimits& limits) {
  if (!usable(from) || !usable(to) || !std::isfinite(yaw)) {
    return Error{"position or yaw is not usable"};
  }
  if (!usable(limits)) return bad_limits();
  FlightReference reference;
  reference.start_ = start;
  reference.end_ = start;
  reference.rest_ = with_yaw(to, yaw);
  const double distance = (to - from).norm();
  if (distance == 0.0) return reference;

  // Ramp up, cruise, ramp down. A ramp to speed V lasts T(V) = max(k_a V / a, sqrt(k_j V / j)) and
  // two of them cover V T(V), which grows with V: the speed reached is the least of three.
  const double speed =
      std::min({limits.velocity, std::sqrt(distance * limits.acceleration / kRampAcceleration),
                std::cbrt(distance * distance * limits.jerk / kRampJerk)});
  const double ramp = std::max(kRampAcceleration * speed / limits.acceleration,
                               std::sqrt(kRampJerk * speed / limits.jerk));
  const double cruise = std::max(0.0, distance / speed - ramp);
  const Vector4d direction = with_yaw((to - from) / distance, 0.0);
  const double covered = 0.5 * speed * ramp;  // by one ramp

  Piece& up = reference.piece_[0];
  up.duration = ramp;
  up.coefficients.col(0) = with_yaw(from, yaw);
  // Integrals of the smoothstep and of one minus it.
  up.coefficients.col(4) = direction * (speed * ramp * 2.5);
  up.coefficients.col(5) = direction * (speed * ramp * -3.0);
  up.coefficients.col(6) = direction * (speed * ramp * 1.0);

  Piece& straight = reference.piece_[1];
  straight.begin = ramp;
  straight.duration = cruise;
  straight.coefficients.col(0) = with_yaw(from, yaw) + direction * covered;
  straight.coefficients.col(1) = direction * (speed * cruise);

  Piece& down = reference.piece_[2];
  down.begin = ramp + cruise;
  down.duration = ramp;
  down.coefficients = -up.coefficients;
  down.coefficients.col(0) = with_yaw(to, yaw) - direction * covered;
  down.coefficients.col(1) = direction * (speed * ramp);

  reference.pieces_ = 3;
  reference.end_ = start + from_seconds(2.0 * ramp + cruise);
  return reference;
}

Result<FlightReference> FlightReference::brake(Time start, const FlatReference& from,
                                               const ReferenceLimits& limits) {
  const Vector3d turning(from.yaw_rate, from.yaw_acceleration, 0.0);
  const auto moderate = [](const Vector3d& v) {
    return v.allFinite() && v.cwiseAbs().maxCoeff() <= kMaxDerivative;
  };
  if (!usable(from.position) || !std::isfinite(from.yaw) || !moderate(from.velocity) ||
      !moderate(from.acceleration) || !moderate(turning)) {
    return Error{"the reference to brake from is not usable"};
  }
  if (!usable(limits)) return bad_limits();

  // One duration for all axes keeps a straight line straight.
  const double T = std::max(
      brake_duration(from.velocity, from.acceleration, limits.acceleration, limits.jerk),
      brake_duration(Vector3d(from.yaw_rate, 0.0, 0.0), Vector3d(from.yaw_acceleration, 0.0, 0.0),
                     limits.yaw_acceleration, limits.yaw_jerk));
  FlightReference reference;
  reference.start_ = start;
  reference.end_ = start + from_seconds(T);
  reference.rest_ = with_yaw(from.position, from.yaw);
  if (T == 0.0) return reference;

  const Vector4d v0 = with_yaw(from.velocity, from.yaw_rate);
  const Vector4d a0 = with_yaw(from.acceleration, from.yaw_acceleration);
  Piece& piece = reference.piece_[0];
  piece.duration = T;
  piece.coefficients.col(0) = reference.rest_;
  for (int k = 0; k < 6; ++k) {
    const auto i = static_cast<std::size_t>(k);
    piece.coefficients.col(k + 1) = T / (k + 1) * (v0 * kH0[i] + a0 * (T * kH1[i]));
  }
  reference.rest_ = piece.coefficients.rowwise().sum();
  reference.pieces_ = 1;
  return reference;
}

FlatReference FlightReference::evaluate(const Piece& piece, double since_start) const {
  const double T = piece.duration;
  const double s = std::clamp((since_start - piece.begin) / T, 0.0, 1.0);
  // Horner for the polynomial and its first four derivatives at once.
  std::array<Vector4d, 5> d;
  d.fill(Vector4d::Zero());
  for (int k = kPowers - 1; k >= 0; --k) {
    for (std::size_t order = 4; order > 0; --order) {
      d[order] = d[order] * s + static_cast<double>(order) * d[order - 1];
    }
    d[0] = d[0] * s + piece.coefficients.col(k);
  }
  const double r = 1.0 / T;
  return {d[0].head<3>(),
          d[1].head<3>() * r,
          d[2].head<3>() * (r * r),
          d[3].head<3>() * (r * r * r),
          d[4].head<3>() * (r * r * r * r),
          d[0].w(),
          d[1].w() * r,
          d[2].w() * (r * r)};
}

FlatReference FlightReference::at(Time time) const {
  FlatReference rest;
  rest.position = rest_.head<3>();
  rest.yaw = rest_.w();
  if (pieces_ == 0 || time >= end_) return rest;
  const double t = time <= start_ ? 0.0 : to_seconds(time - start_);
  int i = 0;
  while (i + 1 < pieces_ && t >= piece_[static_cast<std::size_t>(i + 1)].begin) ++i;
  return evaluate(piece_[static_cast<std::size_t>(i)], t);
}

Trajectory FlightReference::trajectory() const {
  std::vector<TrajectorySegment> segments;
  for (int i = 0; i < pieces_; ++i) {
    const Piece& piece = piece_[static_cast<std::size_t>(i)];
    TrajectorySegment segment;
    segment.duration_s = piece.duration;
    for (int axis = 0; axis < 4; ++axis) {
      segment.coefficients[static_cast<std::size_t>(axis)].head<kPowers>() =
          piece.coefficients.row(axis).transpose();
    }
    if (piece.duration > 0.0) segments.push_back(segment);
  }
  if (segments.empty()) return resting_at(at(end_), end_);
  return Trajectory(start_, std::move(segments));
}

}  // namespace swiftlet
