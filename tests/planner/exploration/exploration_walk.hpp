// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "planner/exploration/cell_ways.hpp"
#include "planner/exploration/explorer.hpp"
#include "planner/exploration/mapped_share.hpp"
#include "tests/planner/exploration/random_house.hpp"

namespace swiftlet::test {

/// A point that explores a house: it scans, asks where to, and goes there through what is known.
struct ExplorationWalk {
  using Rule =
      std::function<ExplorationStep(const OccupancyGrid&, const Eigen::Vector2d& position)>;

  ExplorationWalk(RandomHouse& house, const Eigen::Vector2d& start)
      : plan(house.plan), random(house.random), position(start) {}

  /// Until the rule says that it is done, and home. False where it never ends, or is stuck.
  bool run(const Rule& rule, double clearance) {
    const Eigen::Vector2d home = position;
    for (int i = 0; i < kMostSteps; ++i) {
      scan();
      last = rule(grid, position);
      if (last.kind == ExplorationStep::Kind::kStuck) return false;
      if (last.kind == ExplorationStep::Kind::kFinished) {
        go(home, clearance, 1e9);
        return (position - home).norm() < 0.2;
      }
      go(last.viewpoint, clearance, 0.4);
    }
    return false;
  }

  void scan() {
    const LaserScan turn = plan.scan({position, 0.0}, 720, 2.0 * M_PI, 0.01, random);
    for (int i = 0; i < 2; ++i) {
      const auto inserted =
          grid.insert(turn, {position.x(), position.y(), 1.0}, Eigen::Quaterniond::Identity());
      if (!inserted.ok()) std::abort();
    }
  }

  /// At most so far.
  void go(const Eigen::Vector2d& goal, double clearance, double most) {
    DistanceField::Params params;
    params.unknown_is_obstacle = true;
    params.max_distance = 1.0;
    const DistanceField field(grid, params);
    const CellWays ways(StandingSpace(field, clearance), grid.cell_of(goal));
    double walked = 0.0;
    Cell at = grid.cell_of(position);
    while (walked < most && at != grid.cell_of(goal)) {
      Cell best = at;
      double least = std::numeric_limits<double>::infinity();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell next{at.x + dx, at.y + dy};
          if (next == at || !field.contains(next)) continue;
          const double to_go = ways.length(next) + 1e-3 * std::hypot(dx, dy);
          if (to_go < least) {
            least = to_go;
            best = next;
          }
        }
      }
      if (best == at || !(least < ways.length(at) + 0.1 || !ways.reaches(at))) break;
      walked += (grid.center_of(best) - position).norm();
      position = grid.center_of(best);
      at = best;
      track.push_back(position);
    }
    length += walked;
  }

  /// See swiftlet::mapped_share.
  double mapped_share(const RandomHouse& house, const Eigen::Vector2d& start, double radius) const {
    const double cell = grid.resolution();
    OccupancyGrid truth(grid.params(), {-1.0, -1.0},
                        static_cast<int>((RandomHouse::kWidth + 2.0) / cell),
                        static_cast<int>((RandomHouse::kHeight + 2.0) / cell));
    for (int y = 0; y < truth.height(); ++y) {
      for (int x = 0; x < truth.width(); ++x) {
        const bool free = house.is_free(truth.center_of({x, y}), 1e-9);
        truth.set_state({x, y}, free ? CellState::kFree : CellState::kOccupied);
      }
    }
    return swiftlet::mapped_share(truth, grid, start, radius);
  }

  static constexpr int kMostSteps = 2000;
  const FloorPlan& plan;
  std::mt19937& random;
  Eigen::Vector2d position;
  OccupancyGrid grid;
  double length = 0.0;
  std::vector<Eigen::Vector2d> track;
  ExplorationStep last;
};

}  // namespace swiftlet::test
