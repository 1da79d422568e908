// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace swiftlet::screen {

/// A map as it was heard: 0 to 100 % occupied, -1 unknown, row by row from the lowest y.
struct GridMap {
  int width = 0;
  int height = 0;
  double resolution = 0.0;                           ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner of the first cell [m]
  std::vector<std::int8_t> cells;

  bool usable() const;
};

/// What of the world is on the screen, north up: in dots, which are square.
struct MapView {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
  double metres_per_dot = 0.1;

  bool operator==(const MapView& other) const {
    return centre == other.centre && metres_per_dot == other.metres_per_dot;
  }
};

/// Where a place is, in dots from the upper left corner of a picture of `width` x `height` dots.
Eigen::Vector2d to_dots(const MapView& view, int width, int height, const Eigen::Vector2d& place);

/// The corners of what is known of a map, lower and upper [m].
struct Extent {
  Eigen::Vector2d lower;
  Eigen::Vector2d upper;
};
std::optional<Extent> known_extent(const GridMap& map);

/// A map in dots of the screen. A dot is occupied where any cell in it is, so that a wall of one
/// cell never vanishes; and it is free where none is occupied and any is free. It is made anew only
/// when the map or the view is another.
class MapPicture {
 public:
  enum class Dot : std::uint8_t { kUnknown, kFree, kOccupied };
  /// Of cells at least so probable that something is there [%].
  static constexpr int kOccupied = 65;
  static constexpr int kFree = 35;

  /// True where it had to be made anew. A map that is heard later is another object.
  bool update(std::shared_ptr<const GridMap> map, const MapView& view, int width, int height);
  int width() const { return width_; }    ///< dots
  int height() const { return height_; }  ///< dots
  Dot at(int x, int y) const {
    return dots_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)];
  }

 private:
  void draw();

  std::shared_ptr<const GridMap> map_;
  MapView view_;
  int width_ = 0;
  int height_ = 0;
  std::vector<Dot> dots_;
};

}  // namespace swiftlet::screen
