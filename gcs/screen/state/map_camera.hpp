// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "gcs/screen/drawing/map_picture.hpp"

namespace swiftlet::screen {

/// What part of the map is looked at: all that is known, around the vehicle, or where a person
/// moved it. It moves as seldom as it can, so that the picture is calm.
class MapCamera {
 public:
  enum class Mode { kAll, kFollow, kFree };
  static constexpr double kFinest = 0.01;    ///< [m] a dot
  static constexpr double kCoarsest = 20.0;  ///< [m] a dot
  static constexpr double kStep = 1.25;      ///< of one zoom

  Mode mode() const { return mode_; }
  void show_all() { mode_ = Mode::kAll; }
  void follow() { mode_ = Mode::kFollow; }
  void zoom_in() { zoom(-1); }
  void zoom_out() { zoom(1); }
  /// By shares of the picture, to the right and up.
  void pan(double right, double up);

  /// To be called before each picture, of `width` x `height` dots. The cursor, where there is one,
  /// is kept in the picture.
  const MapView& update(int width, int height, const std::optional<Extent>& known,
                        const std::optional<Eigen::Vector2d>& vehicle,
                        const std::optional<Eigen::Vector2d>& cursor);
  const MapView& view() const { return view_; }
  /// How far a cursor moves with a key: a round length, one column or a little more [m].
  double cursor_step() const;

 private:
  void zoom(int steps);
  void show(const Extent& extent);
  void keep_inside(const Eigen::Vector2d& place, double margin);

  Mode mode_ = Mode::kAll;
  MapView view_;
  int width_ = 1;
  int height_ = 1;
};

}  // namespace swiftlet::screen
