// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/mapped_share.hpp"

#include "perception/distance_field.hpp"
#include "planner/exploration/cell_ways.hpp"

namespace swiftlet {

double mapped_share(const OccupancyGrid& truth, const OccupancyGrid& map,
                    const Eigen::Vector2d& start, double radius) {
  DistanceField::Params params;
  params.max_distance = radius + 4.0 * truth.resolution();
  const StandingSpace standing(DistanceField(truth, params), radius + 2.0 * truth.resolution());
  const auto begin = standing.nearest(truth.cell_of(start));
  if (!begin) return 0.0;
  OccupancyGrid centres(truth.params(), truth.origin(), truth.width(), truth.height());
  const CellWays ways(standing, *begin);
  for (const Cell cell : ways.reached()) {
    centres.set_state(cell, CellState::kOccupied);
  }
  const DistanceField to_centre(centres, params);
  int all = 0, known = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      if (to_centre.distance({x, y}) > radius) continue;
      ++all;
      if (map.state(map.cell_of(truth.center_of({x, y}))) == CellState::kFree) ++known;
    }
  }
  return static_cast<double>(known) / all;
}

}  // namespace swiftlet
