// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "gcs/screen/state/key_bindings.hpp"
#include "gcs/screen/state/map_camera.hpp"

namespace swiftlet::screen {

/// What keys do to the map alone: what part of it is looked at, and where its cursor is.
class MapKeys {
 public:
  MapCamera& camera() { return camera_; }
  const MapCamera& camera() const { return camera_; }
  /// Where there is one [m].
  const std::optional<Eigen::Vector2d>& cursor() const { return cursor_; }

  /// Zoom and its like; false where the deed is another one.
  bool look(Deed deed);
  /// Arrows without a cursor.
  void pan(Deed deed);
  /// A cursor at the vehicle, else in the middle of what is looked at.
  void begin_cursor(const std::optional<Eigen::Vector3d>& vehicle);
  /// Arrows with one.
  void move_cursor(Deed deed);
  void end_cursor() { cursor_.reset(); }

 private:
  MapCamera camera_;
  std::optional<Eigen::Vector2d> cursor_;
};

}  // namespace swiftlet::screen
