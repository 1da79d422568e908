// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/trajectory/bernstein.hpp"

namespace swiftlet {

/// What is known of a function of t in [-1, 1]: it differs from value + slope * t by at most
/// `error`. A Taylor model of first order: over an interval that is halved, the error of everything
/// below shrinks to a quarter.
struct Enclosure {
  double value = 0.0;
  double slope = 0.0;
  double error = 0.0;  ///< not negative; infinite where nothing is known

  double upper() const { return value + std::abs(slope) + error; }
  double lower() const { return value - std::abs(slope) - error; }
};

inline Enclosure operator+(const Enclosure& a, const Enclosure& b) {
  return {a.value + b.value, a.slope + b.slope, a.error + b.error};
}

inline Enclosure operator-(const Enclosure& a, const Enclosure& b) {
  return {a.value - b.value, a.slope - b.slope, a.error + b.error};
}

inline Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  // t^2 is 1/2, give or take as much.
  const double bend = 0.5 * a.slope * b.slope;
  const double a_most = std::abs(a.value) + std::abs(a.slope);
  const double b_most = std::abs(b.value) + std::abs(b.slope);
  return {a.value * b.value + bend, a.value * b.slope + a.slope * b.value,
          std::abs(bend) + a_most * b.error + b_most * a.error + a.error * b.error};
}

/// 1 / a. Nothing is known where a may be zero or negative.
inline Enclosure inverse(const Enclosure& a) {
  const double low = a.lower(), high = a.upper();
  if (!(low > 0.0)) return {0.0, 0.0, std::numeric_limits<double>::infinity()};
  // Between the chord over [low, high] and the tangent that is parallel to it.
  const double steepness = -1.0 / (low * high);
  const double gap = std::pow(1.0 / std::sqrt(low) - 1.0 / std::sqrt(high), 2);
  return {1.0 / low + 1.0 / high + steepness * a.value - 0.5 * gap, steepness * a.slope,
          -steepness * a.error + 0.5 * gap};
}

inline Enclosure cosine(const Enclosure& a) {
  const double spread = std::abs(a.slope) + a.error;
  return {std::cos(a.value), -std::sin(a.value) * a.slope, a.error + 0.5 * spread * spread};
}

inline Enclosure sine(const Enclosure& a) {
  const double spread = std::abs(a.slope) + a.error;
  return {std::sin(a.value), std::cos(a.value) * a.slope, a.error + 0.5 * spread * spread};
}

/// A polynomial from its Bernstein coefficients: the chord of its ends, and how far the others are
/// off it.
template <class Vector>
Enclosure enclose(const Vector& b) {
  const auto n = b.size() - 1;
  const double first = b[0], last = b[n];
  double least = 0.0, most = 0.0;
  for (Eigen::Index i = 1; i < n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n);
    const double off = b[i] - (first + share * (last - first));
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return {0.5 * (first + last + least + most), 0.5 * (last - first), 0.5 * (most - least)};
}

// The same of plain numbers, for formulas that are written once for both.
inline double inverse(double a) {
  return 1.0 / a;
}
inline double cosine(double a) {
  return std::cos(a);
}
inline double sine(double a) {
  return std::sin(a);
}

}  // namespace swiftlet
