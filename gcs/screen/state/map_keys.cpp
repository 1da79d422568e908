// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/map_keys.hpp"

#include <cmath>

namespace swiftlet::screen {
namespace {

/// Of a picture, with one key.
constexpr double kPan = 0.25;

/// A place that a person can read and write down: no 3.0000000000000004.
double on_grid(double steps, double step) {
  constexpr double kPerMetre = 1e6;
  return std::round(steps * step * kPerMetre) / kPerMetre;
}

/// Right and up, in keys.
Eigen::Vector2d direction_of(Deed deed) {
  if (deed == Deed::kLeft) return {-1.0, 0.0};
  if (deed == Deed::kRight) return {1.0, 0.0};
  if (deed == Deed::kDown) return {0.0, -1.0};
  if (deed == Deed::kUp) return {0.0, 1.0};
  return {0.0, 0.0};
}

}  // namespace

bool MapKeys::look(Deed deed) {
  switch (deed) {
    case Deed::kZoomIn:
      camera_.zoom_in();
      return true;
    case Deed::kZoomOut:
      camera_.zoom_out();
      return true;
    case Deed::kFollow:
      camera_.follow();
      return true;
    case Deed::kShowAll:
      camera_.show_all();
      return true;
    default:
      return false;
  }
}

void MapKeys::pan(Deed deed) {
  const Eigen::Vector2d by = kPan * direction_of(deed);
  if (!by.isZero()) camera_.pan(by.x(), by.y());
}

void MapKeys::begin_cursor(const std::optional<Eigen::Vector3d>& vehicle) {
  const double step = camera_.cursor_step();
  const Eigen::Vector2d at = vehicle ? Eigen::Vector2d(vehicle->head<2>()) : camera_.view().centre;
  cursor_ = {on_grid(std::round(at.x() / step), step), on_grid(std::round(at.y() / step), step)};
}

void MapKeys::move_cursor(Deed deed) {
  const double step = camera_.cursor_step();
  const Eigen::Vector2d by = direction_of(deed);
  for (const int axis : {0, 1}) {
    double& coordinate = (*cursor_)[axis];
    if (by[axis] != 0.0) coordinate = on_grid(std::round(coordinate / step) + by[axis], step);
  }
}

}  // namespace swiftlet::screen
