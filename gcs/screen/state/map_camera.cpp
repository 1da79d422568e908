// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/map_camera.hpp"

#include <algorithm>
#include <cmath>

#include "gcs/screen/drawing/braille.hpp"
#include "gcs/screen/drawing/map_drawing.hpp"

namespace swiftlet::screen {
namespace {

/// Around what is known [m].
constexpr double kBorder = 0.5;
/// The vehicle is kept so far from the edge, and the cursor, as shares of the picture.
constexpr double kVehicleMargin = 0.25;
constexpr double kCursorMargin = 0.06;

}  // namespace

void MapCamera::zoom(int steps) {
  // Where all was shown, it is not any more: what one looks at stays in the middle.
  if (mode_ == Mode::kAll) mode_ = Mode::kFree;
  view_.metres_per_dot =
      std::clamp(view_.metres_per_dot * std::pow(kStep, steps), kFinest, kCoarsest);
}

void MapCamera::pan(double right, double up) {
  mode_ = Mode::kFree;
  view_.centre += view_.metres_per_dot * Eigen::Vector2d(right * width_, up * height_);
}

const MapView& MapCamera::update(int width, int height, const std::optional<Extent>& known,
                                 const std::optional<Eigen::Vector2d>& vehicle,
                                 const std::optional<Eigen::Vector2d>& cursor) {
  width_ = std::max(width, 1);
  height_ = std::max(height, 1);
  if (mode_ == Mode::kAll && (known || vehicle)) {
    Extent extent = known.value_or(Extent{*vehicle, *vehicle});
    for (const auto& place : {vehicle, cursor}) {
      if (!place) continue;
      extent.lower = extent.lower.cwiseMin(*place);
      extent.upper = extent.upper.cwiseMax(*place);
    }
    show(extent);
  } else if (mode_ == Mode::kFollow && vehicle && !cursor) {
    keep_inside(*vehicle, kVehicleMargin);
  }
  if (mode_ != Mode::kAll && cursor) keep_inside(*cursor, kCursorMargin);
  return view_;
}

void MapCamera::show(const Extent& extent) {
  const Eigen::Vector2d size = (extent.upper - extent.lower).array() + 2.0 * kBorder;
  const double needed = std::max(size.x() / width_, size.y() / height_);
  // In steps, so that a map that grows does not move with each scan.
  const double steps = std::ceil(std::log(needed / kFinest) / std::log(kStep) - 1e-9);
  view_.metres_per_dot = std::clamp(kFinest * std::pow(kStep, steps), kFinest, kCoarsest);
  const double grid = 4.0 * view_.metres_per_dot;
  const Eigen::Vector2d middle = 0.5 * (extent.lower + extent.upper);
  view_.centre = {std::round(middle.x() / grid) * grid, std::round(middle.y() / grid) * grid};
}

void MapCamera::keep_inside(const Eigen::Vector2d& place, double margin) {
  const Eigen::Vector2d half =
      (0.5 - margin) * view_.metres_per_dot * Eigen::Vector2d(width_, height_);
  const Eigen::Vector2d offset = place - view_.centre;
  // The middle of the picture goes there: it moves seldom, and then far.
  if (std::abs(offset.x()) > half.x()) view_.centre.x() = place.x();
  if (std::abs(offset.y()) > half.y()) view_.centre.y() = place.y();
}

double MapCamera::cursor_step() const {
  const double column = view_.metres_per_dot * Braille::kAcross;
  const double below = round_length(column);
  if (below >= column * (1.0 - 1e-9)) return below;
  // The next of 1, 2, 5, 10, ...: at most two and a half times as long.
  return round_length(below * 2.5);
}

}  // namespace swiftlet::screen
