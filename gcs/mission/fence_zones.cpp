// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/fence_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

constexpr double kStep = 0.5;     // between places on a way that are looked at [m]
constexpr int kMostSteps = 5000;  // of one way: longer ones are mistakes anyway

Eigen::Vector2d in_plane(const GlobalPosition& place, const LocalOrigin& origin) {
  return origin.to_map({place.latitude, place.longitude, origin.position().altitude}).head<2>();
}

}  // namespace

FenceZones::FenceZones(const std::vector<FenceZone>& zones, const LocalOrigin& origin) {
  for (const FenceZone& given : zones) {
    Zone zone;
    zone.stay_inside = given.stay_inside;
    zone.line = given.line;
    zone.centre = in_plane(given.centre, origin);
    zone.radius = given.radius;
    for (const GlobalPosition& corner : given.corners) {
      zone.corners.push_back(in_plane(corner, origin));
    }
    keeps_in_ = keeps_in_ || zone.stay_inside;
    zones_.push_back(zone);
  }
}

bool FenceZones::Zone::contains(const Eigen::Vector2d& point) const {
  if (corners.empty()) return (point - centre).norm() <= radius;
  bool inside = false;  // odd number of edges to the right (Shimrat 1962)
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d &a = corners[i], &b = corners[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

std::string FenceZones::problem_at(const Eigen::Vector2d& point) const {
  const auto line = [](const Zone& zone) {
    return zone.line > 0 ? fmt::format(" (line {})", zone.line) : "";
  };
  bool is_in = false;
  for (const Zone& zone : zones_) {
    if (!zone.contains(point)) continue;
    if (!zone.stay_inside) return fmt::format("is in an area to stay out of{}", line(zone));
    is_in = true;
  }
  return is_in || !keeps_in_ ? "" : "is outside of the area to stay in";
}

std::string FenceZones::problem_of_way(const Eigen::Vector2d& from,
                                       const Eigen::Vector2d& to) const {
  const double way = (to - from).norm();
  if (std::string problem = problem_at(to); !problem.empty()) return "its end " + problem;
  const int steps = static_cast<int>(std::min<double>(kMostSteps, std::ceil(way / kStep)));
  for (int i = 0; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const std::string problem = problem_at(from + share * (to - from));
    if (!problem.empty()) return fmt::format("{:.1f} m on its way {}", share * way, problem);
  }
  return "";
}

}  // namespace swiftlet
