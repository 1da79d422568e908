// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/body_rate.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "planner/trajectory/enclosure.hpp"

namespace swiftlet {
namespace {

/// What the body rate depends on: thrust per mass and jerk in the world, yaw and its rate.
enum Quantity { kForce = 0, kJerk = 3, kYawAngle = 6, kYawRate = 7, kQuantities = 8 };

/// Square of the body rate, for numbers and for enclosures; `q[i]` are the quantities.
template <class Scalar>
Scalar squared_rate(const Scalar* q) {
  const Scalar cos = cosine(q[kYawAngle]), sin = sine(q[kYawAngle]);
  const auto along = [&](int v) { return q[v] * cos + q[v + 1] * sin; };
  const auto aside = [&](int v) { return q[v + 1] * cos - q[v] * sin; };
  const Scalar c = along(kForce), l = aside(kForce), u = q[kForce + 2];
  const Scalar j_c = along(kJerk), j_l = aside(kJerk), j_u = q[kJerk + 2];
  const Scalar m = l * l + u * u;
  const Scalar n = q[kForce] * q[kForce] + q[kForce + 1] * q[kForce + 1] + u * u;
  const Scalar per_m = inverse(m), per_n = inverse(n);
  const Scalar k = u * j_l - l * j_u;
  const Scalar pitch = j_c * m - c * (l * j_l + u * j_u);
  const Scalar yaw = q[kYawRate] * u * n - k * c;
  return (k * k + pitch * pitch * per_n + yaw * yaw * per_m) * per_n * per_m;
}

/// The quantities as polynomials on a part of the segment, one column each in Bernstein form.
struct RatePiece {
  using Matrix = Eigen::Matrix<double, kCoefficients, kQuantities, Eigen::RowMajor>;

  explicit RatePiece(Matrix bernstein) : b(std::move(bernstein)) {
    Enclosure quantities[kQuantities];
    for (int i = 0; i < kQuantities; ++i) quantities[i] = enclose(b.col(i));
    above = squared_rate(quantities).upper();
    if (!std::isfinite(above)) above = std::numeric_limits<double>::infinity();
    taken = 0.0;
    for (const double rate :
         {squared_rate(b.row(0).data()), squared_rate(b.row(kCoefficients - 1).data())}) {
      if (std::isfinite(rate)) taken = std::max(taken, rate);
    }
  }
  std::pair<RatePiece, RatePiece> halves() const {
    auto [left, right] = bernstein_halves(b);
    return {RatePiece(std::move(left)), RatePiece(std::move(right))};
  }

  Matrix b;
  double above = 0.0, taken = 0.0;
};

}  // namespace

double body_rate(const FlatReference& reference) {
  const Eigen::Vector3d& a = reference.acceleration;
  const Eigen::Vector3d& j = reference.jerk;
  const double quantities[kQuantities] = {a.x(), a.y(), a.z() + kGravity, j.x(),
                                          j.y(), j.z(), reference.yaw,    reference.yaw_rate};
  const double squared = squared_rate(quantities);
  return std::isnan(squared) ? std::numeric_limits<double>::infinity() : std::sqrt(squared);
}

double max_body_rate(const TrajectorySegment& segment, double good_enough) {
  const double T = segment.duration_s;
  RatePiece::Matrix power;
  for (int axis = kX; axis <= kZ; ++axis) {
    const Polynomial& position = segment.coefficients[static_cast<std::size_t>(axis)];
    power.col(kForce + axis) = differentiate(position, 2) / (T * T);
    power.col(kJerk + axis) = differentiate(position, 3) / (T * T * T);
  }
  power(0, kForce + 2) += kGravity;
  power.col(kYawAngle) = segment.coefficients[kYaw];
  power.col(kYawRate) = differentiate(segment.coefficients[kYaw]) / T;
  return std::sqrt(least_upper_bound(RatePiece(to_bernstein(power)), good_enough * good_enough));
}

}  // namespace swiftlet
