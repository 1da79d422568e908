// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/map_figure.hpp"

#include <limits>

#include "components/plot/figure.hpp"

namespace swiftlet {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// The borders between free and blocked in a layer, as long as they are straight.
plot::Series walls(const VoxelGrid& grid, int z) {
  plot::Series series{"", {}, {}, {plot::kBlack, plot::Dash::kSolid, plot::Marker::kNone, 1.0}};
  const auto add = [&series](double x0, double y0, double x1, double y1) {
    series.x.insert(series.x.end(), {x0, x1, kGap});
    series.y.insert(series.y.end(), {y0, y1, kGap});
  };
  const auto differ = [&](Voxel a, Voxel b) { return grid.blocked(a) != grid.blocked(b); };
  for (int y = 0; y <= grid.size_y(); ++y) {
    for (int x = 0, begin = 0; x <= grid.size_x(); ++x) {
      if (x < grid.size_x() && differ({x, y - 1, z}, {x, y, z})) continue;
      if (x > begin) add(begin, y, x, y);
      begin = x + 1;
    }
  }
  for (int x = 0; x <= grid.size_x(); ++x) {
    for (int y = 0, begin = 0; y <= grid.size_y(); ++y) {
      if (y < grid.size_y() && differ({x - 1, y, z}, {x, y, z})) continue;
      if (y > begin) add(x, begin, x, y);
      begin = y + 1;
    }
  }
  return series;
}

}  // namespace

Status draw_map(const VoxelGrid& grid, const std::vector<SpaceLine>& lines,
                const std::string& title, const std::filesystem::path& file) {
  plot::Figure figure;
  figure.panel_width = figure.panel_height = 900;
  plot::Panel& panel = figure.panel(title, "x [cells]", "y [cells]");
  panel.equal_aspect = true;
  panel.legend = plot::Legend::kNone;
  const int layer =
      lines.empty() ? 0 : static_cast<int>(lines.front()[lines.front().size() / 2].z());
  panel.series.push_back(walls(grid, layer));
  for (const SpaceLine& line : lines) {
    std::vector<double> x, y;
    for (const Eigen::Vector3d& point : line) {
      x.push_back(point.x());
      y.push_back(point.y());
    }
    panel.add("", x, y);
  }
  return figure.save(file);
}

}  // namespace swiftlet
