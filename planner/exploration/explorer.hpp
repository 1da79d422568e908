// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "perception/distance_field.hpp"
#include "perception/occupancy_grid.hpp"
#include "planner/exploration/frontiers.hpp"

namespace swiftlet {

class CellWays;

/// Where to look next.
struct ExplorationStep {
  enum class Kind {
    kLook,      ///< fly to the viewpoint
    kFinished,  ///< nothing that can be reached shows anything new
    kStuck,     ///< the vehicle stands where it cannot know a way: the reason says why
  };
  Kind kind = Kind::kFinished;
  Eigen::Vector2d viewpoint = Eigen::Vector2d::Zero();  ///< of kLook [m]
  std::size_t frontiers = 0;                            ///< that can be looked into
  std::string reason;                                   ///< of kStuck
};

/// Exploration of an unknown place, frontier by frontier, the nearest first (Yamauchi, CIRA 1997),
/// each looked into from the place that is nearest to it. To be asked again while the vehicle
/// flies: a frontier that has been seen on the way is none any more, and the next one comes at
/// once; until then nothing else does.
///
/// A frontier counts where some part of the vehicle could come to what is unseen, should that be
/// free at its edge: the unseen inside of furniture is none. The vehicle flies through known free
/// space alone. Every wait ends: a frontier that stays one after `patience` looks, or to whose
/// viewpoint nobody finds a way, is given up; once, when nothing else is left, all of these are
/// tried again.
class Explorer {
 public:
  struct Params {
    double clearance = 0.35;        ///< of ways and viewpoints, from the centre [m]
    double range = 6.0;             ///< a frontier is looked into from no farther [m]
    double frontier_extent = 1.5;   ///< a longer one is several [m]
    double least_area = 0.05;       ///< less that is unseen is not worth a look [m^2]
    double near = 3.0;              ///< in sight and nearer counts as a look [m]
    double arrival_distance = 0.3;  ///< so near to the viewpoint, every step does [m]
    int patience = 5;               ///< looks, one a step, after which nothing new is expected
    /// What others are measured against: on to the viewpoint even where everything has been seen
    /// from the way, and a frontier counts wherever all that is unknown might be free.
    bool rule_of_1997 = false;
  };

  Explorer() : Explorer(Params{}) {}
  explicit Explorer(const Params& params);

  /// The next look, for a vehicle at `position` [m].
  ExplorationStep step(const OccupancyGrid& map, const Eigen::Vector2d& position);
  /// Nobody finds a way to the viewpoint of the last step: what it was for is given up.
  void give_up();
  /// Forgets what was given up.
  void reset();

  const Params& params() const { return params_; }

 private:
  struct Sight;  // a frontier and a place that looks into it
  /// A cell by its place in the world: those of a map change as it grows.
  using Place = std::pair<int, int>;
  static Place place_of(const OccupancyGrid& grid, Cell cell);

  std::vector<std::uint8_t> could_be_swept(const OccupancyGrid& grid, const SeenSpace& space,
                                           Cell start);
  std::vector<Sight> find_sights(const OccupancyGrid& grid, const SeenSpace& space,
                                 const CellWays& ways, const std::vector<Frontier>& frontiers);
  std::optional<Cell> place_at(const Frontier& frontier, const SeenSpace& space,
                               const std::vector<Cell>& places, double range) const;
  bool is_given_up(const OccupancyGrid& grid, const Frontier& frontier) const;
  bool is_on_the_way(const Eigen::Vector2d& position) const;
  std::size_t overlap_with_last(const OccupancyGrid& grid, const Frontier& frontier) const;
  void look_around(const SeenSpace& space, const OccupancyGrid& grid, Cell vehicle,
                   const std::vector<Frontier>& frontiers);

  Params params_;
  DistanceField field_;        // distance to what is not known to be free
  DistanceField hope_;         // distance to what is known not to be free
  std::set<Place> looked_at_;  // frontier that the last step was for
  ExplorationStep last_;       // that was a look
  std::set<Place> known_;      // all frontiers of the last step
  std::set<Place> tried_;      // all frontiers that a step was for
  bool second_chance_ = true;
  std::map<Place, int> looks_;  // at frontiers, from near
};

}  // namespace swiftlet
