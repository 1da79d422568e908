// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/map_picture.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace swiftlet {
namespace {

/// Cells from (x0, y0) up to, but without, (x1, y1).
struct CellBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

CellBox known_part(const OccupancyGrid& grid) {
  CellBox box{grid.width(), grid.height(), 0, 0};
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid.state({x, y}) == CellState::kUnknown) continue;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
             std::max(box.y1, y + 1)};
    }
  }
  return box;
}

/// The most occupied of a square of cells.
CellState state_of(const OccupancyGrid& grid, Cell corner, int edge) {
  CellState most = CellState::kUnknown;
  for (int y = corner.y; y < corner.y + edge; ++y) {
    for (int x = corner.x; x < corner.x + edge; ++x) most = std::max(most, grid.state({x, y}));
  }
  return most;
}

cv::Vec4b pixel_of(CellState state) {
  static_assert(CellState::kUnknown < CellState::kFree && CellState::kFree < CellState::kOccupied);
  if (state == CellState::kOccupied) return {0, 0, 0, 255};
  if (state == CellState::kFree) return {255, 255, 255, 255};
  return {128, 128, 128, 0};
}

}  // namespace

Result<std::optional<MapPicture>> draw_map(const OccupancyGrid& grid, int most_pixels) {
  const CellBox box = known_part(grid);
  if (box.empty()) return std::optional<MapPicture>();
  const int longest = std::max(box.x1 - box.x0, box.y1 - box.y0);
  MapPicture picture;
  const int edge = picture.cells_per_pixel = (longest + most_pixels - 1) / most_pixels;
  const int width = (box.x1 - box.x0 + edge - 1) / edge;
  const int height = (box.y1 - box.y0 + edge - 1) / edge;
  cv::Mat image(height, width, CV_8UC4);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Cell corner{box.x0 + column * edge, box.y0 + row * edge};
      // The first row of a picture is the one with the largest y.
      image.at<cv::Vec4b>(height - 1 - row, column) = pixel_of(state_of(grid, corner, edge));
    }
  }
  try {
    if (!cv::imencode(".png", image, picture.png)) picture.png.clear();
  } catch (const cv::Exception&) {
    picture.png.clear();
  }
  if (picture.png.empty()) return Error{"the map cannot be encoded as PNG"};
  const double pixel = grid.resolution() * edge;
  picture.lower = grid.origin() + grid.resolution() * Eigen::Vector2d(box.x0, box.y0);
  picture.upper = picture.lower + pixel * Eigen::Vector2d(width, height);
  return std::make_optional(std::move(picture));
}

}  // namespace swiftlet
