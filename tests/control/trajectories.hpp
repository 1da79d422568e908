// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet::test {

inline constexpr double kQuarterTurn = 1.5707963267948966;

/// offset + amplitude sin(w t + phase) and its derivatives.
inline double wave(double amplitude, double w, double phase, double t, int order) {
  return amplitude * std::pow(w, order) * std::sin(w * t + phase + order * kQuarterTurn);
}

/// A horizontal lemniscate that also heaves and turns, up to about 4 m/s and 8 m/s^2.
inline FlatReference lemniscate(double t) {
  const auto derivative = [t](int order) {
    return Eigen::Vector3d(wave(2.0, 1.6, 0.0, t, order), wave(0.8, 3.2, 0.0, t, order),
                           wave(0.3, 1.6, 0.7, t, order));
  };
  return {derivative(0) + Eigen::Vector3d(0, 0, 2),
          derivative(1),
          derivative(2),
          derivative(3),
          derivative(4),
          wave(0.6, 0.9, 0.0, t, 0),
          wave(0.6, 0.9, 0.0, t, 1),
          wave(0.6, 0.9, 0.0, t, 2)};
}

/// A circle of 1 m at 3 m/s, nose kept to the east.
inline FlatReference circle(double t) {
  const auto derivative = [t](int order) {
    return Eigen::Vector3d(wave(1.0, 3.0, kQuarterTurn, t, order), wave(1.0, 3.0, 0.0, t, order),
                           0.0);
  };
  return {derivative(0) + Eigen::Vector3d(0, 0, 2),
          derivative(1),
          derivative(2),
          derivative(3),
          derivative(4),
          0.0,
          0.0,
          0.0};
}

}  // namespace swiftlet::test
