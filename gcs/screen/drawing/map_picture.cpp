// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/map_picture.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::screen {
namespace {

/// From the first dot to one past the last.
struct Range {
  int begin = 0;
  int end = 0;
};

/// The dots of cell `index` along one axis, from where cell 0 begins: those whose centre it covers,
/// so that large cells leave no gap, and at least the one around its own centre.
Range dots_of_cell(double origin, double dots_per_cell, int index, int limit) {
  const double begin = origin + index * dots_per_cell;
  const double end = begin + dots_per_cell;
  const double centre = std::floor(0.5 * (begin + end));
  double first = std::ceil(begin - 0.5);
  double last = std::ceil(end - 0.5);
  if (first >= last) {
    first = centre;
    last = centre + 1.0;
  }
  const auto clamp = [limit](double dot) {
    return static_cast<int>(std::clamp(dot, 0.0, static_cast<double>(limit)));
  };
  return {clamp(first), clamp(last)};
}

std::vector<Range> dots_of_cells(double origin, double dots_per_cell, int count, int limit) {
  std::vector<Range> ranges(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    ranges[static_cast<std::size_t>(i)] = dots_of_cell(origin, dots_per_cell, i, limit);
  }
  return ranges;
}

}  // namespace

bool GridMap::usable() const {
  return width > 0 && height > 0 && resolution > 0.0 && origin.allFinite() &&
         cells.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

Eigen::Vector2d to_dots(const MapView& view, int width, int height, const Eigen::Vector2d& place) {
  const Eigen::Vector2d offset = (place - view.centre) / view.metres_per_dot;
  return {0.5 * width + offset.x(), 0.5 * height - offset.y()};
}

std::optional<Extent> known_extent(const GridMap& map) {
  if (!map.usable()) return std::nullopt;
  int left = map.width;
  int right = -1;
  int bottom = map.height;
  int top = -1;
  for (int y = 0; y < map.height; ++y) {
    const auto row = map.cells.begin() + static_cast<std::ptrdiff_t>(y) * map.width;
    const auto known = [](std::int8_t cell) { return cell >= 0; };
    const auto first = std::find_if(row, row + map.width, known);
    if (first == row + map.width) continue;
    bottom = std::min(bottom, y);
    top = y;
    left = std::min(left, static_cast<int>(first - row));
    int last = map.width - 1;
    while (last > right && !known(row[last])) --last;
    right = std::max(right, last);
  }
  if (top < 0) return std::nullopt;
  const auto corner = [&map](int x, int y) {
    return Eigen::Vector2d(map.origin + map.resolution * Eigen::Vector2d(x, y));
  };
  return Extent{corner(left, bottom), corner(right + 1, top + 1)};
}

bool MapPicture::update(std::shared_ptr<const GridMap> map, const MapView& view, int width,
                        int height) {
  if (map == map_ && view == view_ && width == width_ && height == height_) return false;
  map_ = std::move(map);
  view_ = view;
  width_ = std::max(width, 0);
  height_ = std::max(height, 0);
  dots_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), Dot::kUnknown);
  if (map_ != nullptr && map_->usable()) draw();
  return true;
}

void MapPicture::draw() {
  const Eigen::Vector2d origin = to_dots(view_, width_, height_, map_->origin);
  const double dots_per_cell = map_->resolution / view_.metres_per_dot;
  const std::vector<Range> columns = dots_of_cells(origin.x(), dots_per_cell, map_->width, width_);
  // Rows count upwards from the lower edge of the picture, as those of the map do.
  const std::vector<Range> rows =
      dots_of_cells(height_ - origin.y(), dots_per_cell, map_->height, height_);
  const auto visible = [](const Range& range) { return range.begin < range.end; };
  const auto first = std::find_if(columns.begin(), columns.end(), visible);
  const auto last = std::find_if(columns.rbegin(), columns.rend(), visible).base();
  for (int y = 0; y < map_->height; ++y) {
    const Range& row = rows[static_cast<std::size_t>(y)];
    if (!visible(row)) continue;
    const std::int8_t* cell = map_->cells.data() + static_cast<std::ptrdiff_t>(y) * map_->width;
    for (auto column = first; column < last; ++column) {
      const std::int8_t value = cell[column - columns.begin()];
      if (value < 0 || (value > kFree && value < kOccupied)) continue;
      const Dot dot = value >= kOccupied ? Dot::kOccupied : Dot::kFree;
      for (int up = row.begin; up < row.end; ++up) {
        Dot* line = dots_.data() + static_cast<std::ptrdiff_t>(height_ - 1 - up) * width_;
        for (int x = column->begin; x < column->end; ++x) line[x] = std::max(line[x], dot);
      }
    }
  }
}

}  // namespace swiftlet::screen
