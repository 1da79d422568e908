// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/rooms/room_survey.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "perception/slam/local_map.hpp"
#include "perception/slam/scan_map.hpp"
#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;

/// Walls drawn along the axes of a house that stands turned in the map.
class TurnedHouse {
 public:
  explicit TurnedHouse(double turn) : turn_(turn) {}
  void wall(const Vector2d& a, const Vector2d& b) { plan_.add_wall(turn_ * a, turn_ * b); }
  void box(const Vector2d& lower, const Vector2d& upper) {
    wall(lower, {upper.x(), lower.y()});
    wall({upper.x(), lower.y()}, upper);
    wall(upper, {lower.x(), upper.y()});
    wall({lower.x(), upper.y()}, lower);
  }

  /// The rooms of the map that scans from these places make.
  std::vector<Room> survey(const std::vector<Vector2d>& places) {
    std::mt19937 random(1);
    std::vector<LevelledScanPtr> scans;
    std::vector<KeyframePtr> keyframes;
    std::vector<Pose2> poses;
    for (const Vector2d& place : places) {
      poses.push_back({turn_ * place, 0.7 * static_cast<double>(poses.size())});
      auto scan = std::make_shared<LevelledScan>();
      scan->scan = plan_.scan(poses.back(), 1000, 2.0 * M_PI, 0.01, random);
      scan->motion.height = 1.0;
      keyframes.push_back(std::make_shared<const Keyframe>(
          make_keyframe(Time{}, scan_points(scan->scan), std::nullopt)));
      scans.push_back(scan);
    }
    OccupancyGrid::Params params;
    params.clear_without_return = false;
    ScanMap map(params);
    std::vector<LevelledScanPtr> map_scans;
    std::vector<Pose2> map_poses;
    // Several turns from each place, as a vehicle that flies by takes them.
    for (int turn = 0; turn < 3; ++turn) {
      map_scans.insert(map_scans.end(), scans.begin(), scans.end());
      map_poses.insert(map_poses.end(), poses.begin(), poses.end());
    }
    map.update(map_scans, map_poses);
    std::vector<int> all(keyframes.size());
    std::iota(all.begin(), all.end(), 0);
    return survey_rooms(map.grid(), surfaces_of(keyframes, poses, all));
  }

 private:
  Eigen::Rotation2Dd turn_;
  FloorPlan plan_;
};

/// A room of 5 m by 4 m and one of 3.6 m by 4 m with a cupboard, and a door between.
TurnedHouse two_rooms(double turn) {
  TurnedHouse house(turn);
  house.wall({0, 0}, {5, 0});
  house.wall({5, 4}, {0, 4});
  house.wall({0, 4}, {0, 0});
  house.wall({5.12, 0}, {8.72, 0});
  house.wall({8.72, 0}, {8.72, 4});
  house.wall({8.72, 4}, {5.12, 4});
  for (const double x : {5.0, 5.12}) {
    house.wall({x, 0}, {x, 1.5});
    house.wall({x, 2.4}, {x, 4});
  }
  house.wall({5, 1.5}, {5.12, 1.5});
  house.wall({5, 2.4}, {5.12, 2.4});
  house.box({8.12, 2.0}, {8.72, 3.0});
  return house;
}

TEST(RoomSurvey, AreasAndDistancesAreRightToAPercentHoweverTheHouseStands) {
  for (const double turn : {0.0, 0.2, 0.55, -0.7}) {
    SCOPED_TRACE(turn);
    const auto rooms = two_rooms(turn).survey({{1, 1},
                                               {2.5, 2.0},
                                               {4, 3},
                                               {4.5, 1.9},
                                               {5.06, 1.95},
                                               {6, 1},
                                               {7, 2},
                                               {6.2, 3.2},
                                               {7.8, 1}});
    ASSERT_EQ(rooms.size(), 2u);
    constexpr double kDoorway = 0.9 * 0.12;
    EXPECT_NEAR(rooms[0].area, 20.0 + 0.5 * kDoorway, 0.01 * 20.0);
    EXPECT_NEAR(rooms[1].area, 3.6 * 4.0 - 0.6 + 0.5 * kDoorway, 0.01 * 13.8);
    const auto expect_sides = [](const Room& room, double a, double b) {
      EXPECT_NEAR(std::max(room.length, room.width), a, 0.01 * a);
      EXPECT_NEAR(std::min(room.length, room.width), b, 0.01 * b);
    };
    expect_sides(rooms[0], 5.0, 4.0);
    expect_sides(rooms[1], 4.0, 3.6);
    EXPECT_NEAR(std::sin(4.0 * (rooms[0].axis - turn)), 0.0, 0.04);
  }
}

TEST(RoomSurvey, AWideOpeningPartsNoRoom) {
  TurnedHouse house(0.3);
  house.box({0, 0}, {8, 4});
  house.wall({4, 0}, {4, 1.2});
  house.wall({4, 2.8}, {4, 4});
  const auto rooms = house.survey({{1, 1}, {2, 3}, {4, 2}, {6, 1}, {7, 3}});
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 32.0, 0.32);
}

TEST(RoomSurvey, WhereNothingIsKnownThereIsNoRoom) {
  EXPECT_TRUE(survey_rooms(OccupancyGrid(), {}).empty());
}

}  // namespace
}  // namespace swiftlet::test
