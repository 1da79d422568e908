// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/braille.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::screen {
namespace {

/// Bit of the dot at column x and row y (Unicode 15, block U+2800).
constexpr unsigned kBits[Braille::kDown][Braille::kAcross] = {
    {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

/// Cuts [begin, end] of a parameter along a line down to where from + t * slope is in [0, limit].
bool clip(double from, double slope, double limit, double& begin, double& end) {
  if (slope == 0.0) return from >= 0.0 && from <= limit;
  const double at_zero = -from / slope;
  const double at_limit = (limit - from) / slope;
  begin = std::max(begin, std::min(at_zero, at_limit));
  end = std::min(end, std::max(at_zero, at_limit));
  return begin <= end;
}

}  // namespace

Braille::Braille(int width, int height)
    : width_(std::max(width, 0)),
      height_(std::max(height, 0)),
      cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void Braille::dot(int x, int y, int layer) {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return;
  Dots& cell = cells_[static_cast<std::size_t>(y / kDown * width_ + x / kAcross)];
  cell.bits |= kBits[y % kDown][x % kAcross];
  cell.layer = std::max(cell.layer, layer);
}

bool Braille::has(int x, int y) const {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return false;
  const Dots& cell = cells_[static_cast<std::size_t>(y / kDown * width_ + x / kAcross)];
  return (cell.bits & kBits[y % kDown][x % kAcross]) != 0;
}

void Braille::line(double x0, double y0, double x1, double y1, int layer) {
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  if (!std::isfinite(dx) || !std::isfinite(dy)) return;
  double begin = 0.0;
  double end = 1.0;
  // By Liang and Barsky 1984, so that what is far outside costs nothing.
  if (!clip(x0, dx, width(), begin, end) || !clip(y0, dy, height(), begin, end)) return;
  const double length = (end - begin) * std::max(std::abs(dx), std::abs(dy));
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  for (int i = 0; i <= steps; ++i) {
    const double t = begin + (end - begin) * i / steps;
    dot(static_cast<int>(std::floor(x0 + t * dx)), static_cast<int>(std::floor(y0 + t * dy)),
        layer);
  }
}

void Braille::draw(const Pane& pane, const std::vector<Style>& styles) const {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Dots& cell = cells_[static_cast<std::size_t>(y * width_ + x)];
      if (cell.bits == 0) continue;
      pane.put(x, y, kBraille + cell.bits, styles.at(static_cast<std::size_t>(cell.layer)));
    }
  }
}

}  // namespace swiftlet::screen
