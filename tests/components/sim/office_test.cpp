// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The office that is delivered: can its mission be flown, and is it closed where it should be?
#include <queue>

#include "components/sim/simulation.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::filesystem::path kScenarios =
    std::filesystem::path(SWIFTLET_SOURCE_DIR) / "components/sim/scenarios";

/// Cells of 5 cm that a vehicle at the altitude of the mission can reach from its pad.
class Reachable {
 public:
  Reachable(const Simulation& simulation, double radius)
      : map_(simulation.scenario().map),
        columns_(static_cast<int>((map_.max.x() - map_.min.x()) / kCell)),
        rows_(static_cast<int>((map_.max.y() - map_.min.y()) / kCell)),
        reached_(static_cast<std::size_t>(columns_ * rows_), false) {
    const double z = simulation.scenario().mission.takeoff_altitude;
    const auto is_free = [&](int c, int r) {
      const Vector3d p(map_.min.x() + (c + 0.5) * kCell, map_.min.y() + (r + 0.5) * kCell, z);
      return !simulation.world().nearest(p, radius, World::Surfaces::kObstacles);
    };
    std::queue<std::pair<int, int>> open;
    open.push(cell(simulation.start().head<2>()));
    while (!open.empty()) {
      const auto [c, r] = open.front();
      open.pop();
      if (c < 0 || r < 0 || c >= columns_ || r >= rows_) continue;
      const auto index = static_cast<std::size_t>(r * columns_ + c);
      if (reached_[index] || !is_free(c, r)) continue;
      reached_[index] = true;
      for (const auto& [dc, dr] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        open.push({c + dc, r + dr});
      }
    }
  }
  bool at(const Vector2d& p) const {
    const auto [c, r] = cell(p);
    return c >= 0 && r >= 0 && c < columns_ && r < rows_ &&
           reached_[static_cast<std::size_t>(r * columns_ + c)];
  }

 private:
  static constexpr double kCell = 0.05;
  std::pair<int, int> cell(const Vector2d& p) const {
    return {static_cast<int>(std::floor((p.x() - map_.min.x()) / kCell)),
            static_cast<int>(std::floor((p.y() - map_.min.y()) / kCell))};
  }
  Scenario::MapBounds map_;
  int columns_;
  int rows_;
  std::vector<bool> reached_;
};

Vector2d position(const Scenario::Waypoint& waypoint) {
  return {waypoint.x, waypoint.y};
}

TEST(Office, EveryWaypointIsReachableWithTenCentimetresToSpare) {
  const Simulation simulation(Scenario::load(kScenarios / "office.yaml"));
  const Reachable reachable(simulation, 0.25 + 0.10);
  ASSERT_EQ(simulation.scenario().mission.waypoints.size(), 3U);
  for (const auto& waypoint : simulation.scenario().mission.waypoints) {
    EXPECT_TRUE(reachable.at(position(waypoint))) << waypoint.x << " " << waypoint.y;
  }
  // Outside nobody gets.
  EXPECT_FALSE(reachable.at({-0.5, 3.0}));
  EXPECT_FALSE(reachable.at({13.5, 3.0}));
}

TEST(Office, DoorwaysAreNinetyCentimetresWide) {
  const World world = World::load(kScenarios / "../worlds/office.sdf", {"pad"});
  for (const double x : {5.45, 11.65}) {
    const Vector3d middle(x, 2.01, 1.25);
    const auto east = world.cast_ray(middle, Vector3d::UnitX(), 5.0);
    const auto west = world.cast_ray(middle, -Vector3d::UnitX(), 5.0);
    ASSERT_TRUE(east && west);
    EXPECT_NEAR(east->range + west->range, 0.9, 1e-5);
    EXPECT_EQ(east->model, "corridor_wall");
    EXPECT_NEAR(world.cast_ray(middle, Vector3d::UnitZ(), 5.0)->range, 0.75, 1e-5);  // lintel
  }
  const Vector3d corridor(4.0, 1.05, 1.25);
  EXPECT_NEAR(world.cast_ray(corridor, Vector3d::UnitY(), 5.0)->range +
                  world.cast_ray(corridor, -Vector3d::UnitY(), 5.0)->range,
              1.8, 1e-5);
}

TEST(Office, WithoutTheDoorwaysRooms2And3CannotBeReached) {
  for (const auto& [x, waypoint] : {std::pair{5.45, 1}, {11.65, 2}}) {
    Scenario scenario = Scenario::load(kScenarios / "office.yaml");
    Scenario::Obstacle door;
    door.name = "door";
    door.position << x, 2.01, 1.0;
    door.size << 0.9, 0.05, 2.0;
    scenario.obstacles.push_back(door);
    const Simulation simulation(scenario);
    const Reachable reachable(simulation, 0.25);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(reachable.at(position(scenario.mission.waypoints[i])), i != waypoint) << x << i;
    }
  }
}

TEST(Office, TheClosedDoorShutsWaypoint2AndNothingElse) {
  const Simulation simulation(Scenario::load(kScenarios / "office-closed-door.yaml"));
  // Not even a vehicle of 5 cm passes.
  const Reachable reachable(simulation, 0.05);
  const auto& waypoints = simulation.scenario().mission.waypoints;
  EXPECT_TRUE(reachable.at(position(waypoints[0])));
  EXPECT_FALSE(reachable.at(position(waypoints[1])));
  EXPECT_TRUE(reachable.at(position(waypoints[2])));
}

TEST(Office, TheVehicleStandsOnItsPad) {
  Simulation simulation(Scenario::load(kScenarios / "office.yaml"));
  EXPECT_NEAR(simulation.start().z(), 0.02 + simulation.scenario().vehicle.ground.leg_height, 1e-9);
  for (int i = 0; i < 3000; ++i) simulation.step(Simulation::kStep, Eigen::Vector4d::Zero());
  EXPECT_TRUE(simulation.truth().on_ground);
  EXPECT_NEAR((simulation.truth().body.p_WB - simulation.start()).norm(), 0.0, 5e-3);
  EXPECT_EQ(simulation.contacts(), 0);
  EXPECT_TRUE(std::isinf(simulation.min_clearance()));
}

}  // namespace
}  // namespace swiftlet
