// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/degrees.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace swiftlet {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;
constexpr int kMostDigits = 17;  // all that a double has

/// What `from` is undone by, within a rounding.
double degrees_of(double yaw, double (*from)(double)) {
  if (from == from_degrees) return yaw / kDegree;
  const double compass_deg = 90.0 - yaw / kDegree;
  return compass_deg < 0.0 ? compass_deg + 360.0 : compass_deg;
}

}  // namespace

double from_degrees(double degrees) {
  return degrees * kDegree;
}

double from_compass(double compass_deg) {
  const double degrees = std::remainder(90.0 - compass_deg, 360.0);
  return from_degrees(degrees == -180.0 ? 180.0 : degrees);
}

std::string shortest_degrees(double yaw, double (*from)(double)) {
  const double degrees = degrees_of(yaw, from);
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    const std::string text = fmt::format("{:.{}g}", degrees, digits);
    const double rounded = std::strtod(text.c_str(), nullptr);
    if (from(rounded) == yaw) return fmt::format("{}", rounded);
  }
  for (const double neighbour : {std::nextafter(degrees, 1e3), std::nextafter(degrees, -1e3)}) {
    if (from(neighbour) == yaw) return fmt::format("{}", neighbour);
  }
  return fmt::format("{}", degrees);
}

}  // namespace swiftlet
