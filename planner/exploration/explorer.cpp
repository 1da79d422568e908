// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/explorer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "planner/exploration/cell_ways.hpp"

namespace swiftlet {
namespace {

/// Viewpoints are looked for in every so many cells along both axes.
constexpr int kLattice = 4;
/// Unknown space around a map [m].
constexpr double kBorder = 1.0;

DistanceField::Params field_params(double clearance, bool unknown_is_obstacle) {
  DistanceField::Params params;
  params.unknown_is_obstacle = unknown_is_obstacle;
  params.max_distance = clearance + 0.2;
  return params;
}

ExplorationStep stuck(std::string reason) {
  ExplorationStep step;
  step.kind = ExplorationStep::Kind::kStuck;
  step.reason = std::move(reason);
  return step;
}

/// What lies beyond the edge of a map is unknown, too.
Result<OccupancyGrid> with_border(const OccupancyGrid& map) {
  OccupancyGrid grid = map;
  const Eigen::Vector2d size(map.width(), map.height()), border(kBorder, kBorder);
  const Status covered =
      grid.cover(map.origin() - border, map.origin() + size * map.resolution() + border);
  if (!covered.ok()) return covered.error();
  return grid;
}

/// The map, with obstacles where unknown space is so deep that a vehicle at the edge of what has
/// been seen has no part in it.
OccupancyGrid without_the_deep(const OccupancyGrid& grid, const SeenSpace& space, double depth) {
  OccupancyGrid open(grid.params(), grid.origin(), grid.width(), grid.height());
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (space.is_open({x, y})) open.set_state({x, y}, CellState::kOccupied);
    }
  }
  DistanceField::Params params;
  params.max_distance = depth + grid.resolution();
  const DistanceField to_open(open, params);
  OccupancyGrid shallow = grid;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (space.is_unseen({x, y}) && to_open.distance({x, y}) > depth) {
        shallow.set_state({x, y}, CellState::kOccupied);
      }
    }
  }
  return shallow;
}

}  // namespace

struct Explorer::Sight {
  Frontier frontier;
  Cell from;             // where it is looked into from
  double way = 0.0;      // to there [m]
  std::size_t last = 0;  // cells of it that the last step was for
};

Explorer::Explorer(const Params& params)
    : params_(params),
      field_(field_params(params.clearance, true)),
      hope_(field_params(params.clearance, false)) {}

Explorer::Place Explorer::place_of(const OccupancyGrid& grid, Cell cell) {
  const Eigen::Vector2d middle = grid.center_of(cell) / grid.resolution();
  return {static_cast<int>(std::floor(middle.x())), static_cast<int>(std::floor(middle.y()))};
}

bool Explorer::is_given_up(const OccupancyGrid& grid, const Frontier& frontier) const {
  const auto count = std::count_if(frontier.cells.begin(), frontier.cells.end(), [&](Cell cell) {
    const auto looks = looks_.find(place_of(grid, cell));
    return looks != looks_.end() && looks->second >= params_.patience;
  });
  return 2 * static_cast<std::size_t>(count) >= frontier.cells.size();
}

std::size_t Explorer::overlap_with_last(const OccupancyGrid& grid, const Frontier& frontier) const {
  return static_cast<std::size_t>(std::count_if(
      frontier.cells.begin(), frontier.cells.end(),
      [&](Cell cell) { return looked_at_.find(place_of(grid, cell)) != looked_at_.end(); }));
}

/// A byte a cell: whether some part of the vehicle could come there, should what is unknown be free
/// at the edge of what has been seen. (Should all of it be free, ways would lead through the unseen
/// walls of rooms around the house, to the far side of every corner of a wall.)
std::vector<std::uint8_t> Explorer::could_be_swept(const OccupancyGrid& grid,
                                                   const SeenSpace& space, Cell start) {
  const double depth = params_.clearance + grid.resolution();
  hope_.update(params_.rule_of_1997 ? grid : without_the_deep(grid, space, depth));
  OccupancyGrid centres(grid.params(), grid.origin(), grid.width(), grid.height());
  const CellWays ways(StandingSpace(hope_, params_.clearance), start);
  for (const Cell cell : ways.reached()) {
    centres.set_state(cell, CellState::kOccupied);
  }
  DistanceField::Params params;
  params.max_distance = params_.clearance + grid.resolution();
  const DistanceField to_centre(centres, params);
  std::vector<std::uint8_t> swept(to_centre.values().size());
  for (std::size_t i = 0; i < swept.size(); ++i) {
    swept[i] = to_centre.values()[i] <= params_.clearance ? 1 : 0;
  }
  return swept;
}

/// The place that is nearest to a frontier and looks into it.
std::optional<Cell> Explorer::place_at(const Frontier& frontier, const SeenSpace& space,
                                       const std::vector<Cell>& places, double range) const {
  std::optional<Cell> best;
  double least = range;
  for (const Cell place : places) {
    const double distance = std::hypot(place.x - frontier.middle.x, place.y - frontier.middle.y);
    if (distance >= least || !space.sees(place, frontier.middle)) continue;
    least = distance;
    best = place;
  }
  return best;
}

std::vector<Explorer::Sight> Explorer::find_sights(const OccupancyGrid& grid,
                                                   const SeenSpace& space, const CellWays& ways,
                                                   const std::vector<Frontier>& frontiers) {
  std::vector<Cell> places;  // the nearest first
  for (const Cell cell : ways.reached()) {
    if (cell.x % kLattice == 0 && cell.y % kLattice == 0) places.push_back(cell);
  }
  if (places.empty() && !ways.reached().empty()) places.push_back(ways.reached().front());
  const double range = params_.range / grid.resolution();
  std::vector<Sight> sights;
  for (const Frontier& frontier : frontiers) {
    if (frontier.area < params_.least_area || is_given_up(grid, frontier)) continue;
    const std::optional<Cell> best = place_at(frontier, space, places, range);
    if (!best) {
      // Nobody can look into it. Where the vehicle was on the way to do so, the way is not to be
      // relied on: it would turn back and forth.
      for (const Cell cell : frontier.cells) {
        const Place here = place_of(grid, cell);
        if (tried_.find(here) != tried_.end()) ++looks_[here];
      }
      continue;
    }
    const std::size_t last = overlap_with_last(grid, frontier);
    sights.push_back({frontier, *best, ways.length(*best), last});
  }
  return sights;
}

/// Counts looks from near at what is a frontier or was one a step ago: a wall may look like one
/// from afar, and like none from near, again and again.
void Explorer::look_around(const SeenSpace& space, const OccupancyGrid& grid, Cell vehicle,
                           const std::vector<Frontier>& frontiers) {
  std::set<Place> now;
  for (const Frontier& frontier : frontiers) {
    for (const Cell cell : frontier.cells) now.insert(place_of(grid, cell));
  }
  known_.insert(now.begin(), now.end());
  const double near = params_.near / grid.resolution();
  const Cell looked_from = grid.cell_of(last_.viewpoint);
  const bool there = std::hypot(looked_from.x - vehicle.x, looked_from.y - vehicle.y) <=
                     params_.arrival_distance / grid.resolution();
  for (const Place& place : known_) {
    const Cell cell = grid.cell_of(
        {(place.first + 0.5) * grid.resolution(), (place.second + 0.5) * grid.resolution()});
    if (!space.contains(cell)) continue;
    const bool is_near = std::hypot(cell.x - vehicle.x, cell.y - vehicle.y) <= near;
    if (there && looked_at_.find(place) != looked_at_.end()) {
      ++looks_[place];
    } else if (is_near && space.sees(vehicle, cell)) {
      ++looks_[place];
    }
  }
  known_ = std::move(now);
}

void Explorer::give_up() {
  for (const Place& place : looked_at_) looks_[place] = params_.patience;
  looked_at_.clear();
}

void Explorer::reset() {
  looked_at_.clear();
  known_.clear();
  tried_.clear();
  looks_.clear();
  second_chance_ = true;
}

bool Explorer::is_on_the_way(const Eigen::Vector2d& position) const {
  return !looked_at_.empty() && (position - last_.viewpoint).norm() > params_.arrival_distance;
}

/// What the last step was for comes first, as long as it is a frontier: who changes his mind on the
/// way stops, turns, and does it again.
ExplorationStep Explorer::step(const OccupancyGrid& map, const Eigen::Vector2d& position) {
  if (map.empty()) return stuck("there is no map yet");
  if (!position.allFinite()) return stuck("no usable position");
  const auto bordered = with_border(map);
  if (!bordered.ok()) return stuck(bordered.error().reason);
  const OccupancyGrid& grid = *bordered;
  field_.update(grid);
  const StandingSpace standing(field_, params_.clearance);
  const auto start = standing.nearest(grid.cell_of(position));
  if (!start) return stuck("no known free place is large enough for the vehicle where it is");

  const SeenSpace space(grid);
  const CellWays ways(standing, *start);
  if (params_.rule_of_1997 && is_on_the_way(position) &&
      ways.reaches(grid.cell_of(last_.viewpoint))) {
    return last_;
  }
  const std::vector<Frontier> frontiers =
      find_frontiers(space, could_be_swept(grid, space, *start), params_.frontier_extent);
  look_around(space, grid, *start, frontiers);
  std::vector<Sight> sights = find_sights(grid, space, ways, frontiers);
  if (sights.empty() && std::exchange(second_chance_, false)) {
    looks_.clear();
    tried_.clear();
    sights = find_sights(grid, space, ways, frontiers);
  }

  ExplorationStep step;
  step.frontiers = sights.size();
  looked_at_.clear();
  if (sights.empty()) return step;
  const Sight& next =
      *std::min_element(sights.begin(), sights.end(), [](const Sight& a, const Sight& b) {
        return a.last != b.last ? a.last > b.last : a.way < b.way;
      });
  step.kind = ExplorationStep::Kind::kLook;
  step.viewpoint = grid.center_of(next.from);
  for (const Cell cell : next.frontier.cells) looked_at_.insert(place_of(grid, cell));
  tried_.insert(looked_at_.begin(), looked_at_.end());
  last_ = step;
  return step;
}

}  // namespace swiftlet
