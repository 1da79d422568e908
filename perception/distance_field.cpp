// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {
namespace {

/// One-dimensional transform of squared distances `f` [cells^2] into `out`: the lower envelope of
/// the parabolas rooted at (i, f[i]). Whole numbers throughout: exact. `root` and `border` are
/// scratch of the same length; kFar marks the absence of an obstacle.
constexpr std::int64_t kFar = std::int64_t{1} << 60;

void lower_envelope(const std::vector<std::int64_t>& f, std::vector<std::int64_t>& out,
                    std::vector<int>& root, std::vector<double>& border, int n) {
  int parabolas = 0;
  for (int q = 0; q < n; ++q) {
    if (f[static_cast<std::size_t>(q)] >= kFar) continue;
    const auto height = [&](int i) {
      return static_cast<double>(f[static_cast<std::size_t>(i)] + static_cast<std::int64_t>(i) * i);
    };
    double from = -std::numeric_limits<double>::infinity();
    while (parabolas > 0) {
      const int last = root[static_cast<std::size_t>(parabolas - 1)];
      from = (height(q) - height(last)) / (2.0 * (q - last));
      if (from > border[static_cast<std::size_t>(parabolas - 1)]) break;
      --parabolas;
      from = -std::numeric_limits<double>::infinity();
    }
    root[static_cast<std::size_t>(parabolas)] = q;
    border[static_cast<std::size_t>(parabolas)] = from;
    ++parabolas;
  }
  if (parabolas == 0) {
    std::fill_n(out.begin(), n, kFar);
    return;
  }
  int k = 0;
  for (int q = 0; q < n; ++q) {
    while (k + 1 < parabolas && border[static_cast<std::size_t>(k + 1)] < q) ++k;
    const std::int64_t offset = q - root[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(q)] =
        offset * offset + f[static_cast<std::size_t>(root[static_cast<std::size_t>(k)])];
  }
}

}  // namespace

DistanceField::DistanceField() = default;

DistanceField::DistanceField(const Params& params) : params_(params) {}

DistanceField::DistanceField(const OccupancyGrid& grid, const Params& params) : params_(params) {
  update(grid);
}

void DistanceField::update(const OccupancyGrid& grid) {
  origin_ = grid.origin();
  resolution_ = grid.resolution();
  width_ = grid.width();
  height_ = grid.height();
  const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
  distance_.resize(w * h);
  const std::size_t longest = std::max(w, h);
  std::vector<std::int64_t> line(longest), result(longest);
  std::vector<int> root(longest);
  std::vector<double> border(longest);

  // First pass, along the columns: cells to the nearest obstacle above or below. For a line of
  // zeros and infinities two sweeps do what the envelope does.
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max() / 2;
  std::vector<std::int32_t> vertical(w * h);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const CellState state = grid.state({x, y});
      const bool obstacle = state == CellState::kOccupied ||
                            (state == CellState::kUnknown && params_.unknown_is_obstacle);
      const std::size_t i = static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x);
      vertical[i] = obstacle ? 0 : y == 0 ? kNone : std::min(kNone, vertical[i - w] + 1);
    }
  }
  for (std::size_t i = w * h; i-- > 0;) {
    if (i + w < w * h) vertical[i] = std::min(vertical[i], vertical[i + w] + 1);
  }

  // Second pass, along the rows.
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      const std::int64_t cells = vertical[y * w + x];
      line[x] = cells >= kNone ? kFar : cells * cells;
    }
    lower_envelope(line, result, root, border, width_);
    for (std::size_t x = 0; x < w; ++x) {
      const double metres = result[x] >= kFar
                                ? params_.max_distance
                                : resolution_ * std::sqrt(static_cast<double>(result[x]));
      distance_[y * w + x] = static_cast<float>(std::min(metres, params_.max_distance));
    }
  }
}

double DistanceField::distance_at(const Eigen::Vector2d& point) const {
  if (empty()) return params_.max_distance;
  if (!point.allFinite()) return 0.0;
  const Eigen::Vector2d cells = (point - origin_) / resolution_;
  const double x = std::clamp(cells.x() - 0.5, 0.0, static_cast<double>(width_ - 1));
  const double y = std::clamp(cells.y() - 0.5, 0.0, static_cast<double>(height_ - 1));
  const int x0 = std::min(static_cast<int>(x), std::max(0, width_ - 2));
  const int y0 = std::min(static_cast<int>(y), std::max(0, height_ - 2));
  const int x1 = std::min(x0 + 1, width_ - 1), y1 = std::min(y0 + 1, height_ - 1);
  const double u = x - x0, v = y - y0;
  const double below = (1.0 - u) * distance({x0, y0}) + u * distance({x1, y0});
  const double above = (1.0 - u) * distance({x0, y1}) + u * distance({x1, y1});
  return (1.0 - v) * below + v * above;
}

}  // namespace swiftlet
