// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/ground_link/coarse_map.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

/// A float of the message that was meant to be a multiple is one within this.
constexpr double kRounding = 1e-4;
constexpr double kMaxFactor = 1000.0;

}  // namespace

nav_msgs::msg::OccupancyGrid coarsened(const nav_msgs::msg::OccupancyGrid& map, double resolution) {
  const std::size_t width = map.info().width();
  const std::size_t height = map.info().height();
  const double ratio = resolution / static_cast<double>(map.info().resolution());
  const bool sound = map.info().resolution() > 0.0f && map.data().size() == width * height;
  if (!sound || !(ratio > 1.0 + kRounding)) return map;  // a resolution that is NaN, too
  const auto factor = static_cast<std::size_t>(std::ceil(std::min(ratio, kMaxFactor) - kRounding));
  const std::size_t coarse_width = (width + factor - 1) / factor;
  const std::size_t coarse_height = (height + factor - 1) / factor;
  std::vector<std::int8_t> cells(coarse_width * coarse_height, -1);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      std::int8_t& cell = cells[y / factor * coarse_width + x / factor];
      cell = std::max(cell, map.data()[y * width + x]);
    }
  }
  nav_msgs::msg::OccupancyGrid coarse;
  coarse.header(map.header());
  coarse.info(map.info());
  coarse.info().resolution(map.info().resolution() * static_cast<float>(factor));
  coarse.info().width(static_cast<std::uint32_t>(coarse_width));
  coarse.info().height(static_cast<std::uint32_t>(coarse_height));
  coarse.data(std::move(cells));
  return coarse;
}

}  // namespace swiftlet
