// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_check.hpp"

#include <algorithm>

#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = MissionItem::Kind;

const LocalOrigin kOrigin({47.0, 8.0, 400.0});

/// A place on Earth by where it is in the map.
MissionItem earth_at(double x, double y, double altitude) {
  const GlobalPosition place = kOrigin.to_global({x, y, 0.0});
  return on_earth(place.latitude, place.longitude, altitude);
}

MissionItem with_speed(MissionItem item, double speed) {
  item.place.speed = speed;
  return item;
}

MissionCheckParams params_with_origin() {
  MissionCheckParams params;
  params.origin = kOrigin;
  return params;
}

std::vector<std::string> texts(const MissionCheck& check) {
  std::vector<std::string> texts;
  for (const MissionFinding& finding : check.findings) texts.push_back(describe(finding, "m"));
  return texts;
}

std::vector<std::string> findings(const std::vector<MissionItem>& items,
                                  const MissionCheckParams& params = {}) {
  return texts(check_mission(mission_of(items), params));
}

const MissionItem kUp = takeoff_to(1.2);
const MissionItem kDown = item_of(Kind::kLand);
const MissionItem kBack = item_of(Kind::kReturn);

TEST(MissionCheck, AMissionInOrderHasNoFindings) {
  EXPECT_THAT(findings({kUp, in_map(3, 0, 1.2), hold_for(2), in_map(3, 3, 1.2), kBack}), IsEmpty());
  EXPECT_THAT(findings({item_of(Kind::kClaw), kUp, in_map(3, 0, 1.2), kDown}), IsEmpty())
      << "a claw moves on the ground";
}

TEST(MissionCheck, WhatNeedsFlightStandsBetweenTakeoffAndLanding) {
  EXPECT_THAT(
      findings({in_map(3, 0, 1), kDown}),
      ElementsAre(AllOf(HasSubstr("m:1: item 1: error"), HasSubstr("begin with a take-off"))));
  MissionCheckParams flying;
  flying.on_ground = false;
  EXPECT_THAT(findings({in_map(3, 0, 1), kDown}, flying), IsEmpty());
  EXPECT_THAT(findings({kUp, kDown, in_map(3, 0, 1), hold_for(1), kDown}),
              ElementsAre(HasSubstr("m:3: item 3: error: it stands behind the landing")));
  EXPECT_THAT(findings({kUp, kDown, kUp, kDown}),
              ElementsAre(HasSubstr("item 3: warning: the vehicle disarms")));
  EXPECT_THAT(findings({kUp, hold_for(1)}),
              ElementsAre(HasSubstr("m: warning: it ends in the air")));
  EXPECT_THAT(findings({}), ElementsAre(HasSubstr("no items")));
}

TEST(MissionCheck, TheWayToTheFirstWaypointBeginsWhereTheVehicleIs) {
  MissionCheckParams flying = params_with_origin();
  flying.on_ground = false;
  const std::vector<MissionItem> items{earth_at(2000, 0, 5), kBack};
  const auto length = [&] { return check_mission(mission_of(items), flying).length; };
  const double back = length();
  EXPECT_NEAR(back, 2000.0, 1.0) << "who knows from where";
  flying.start = Eigen::Vector3d(1500, 0, 5);
  EXPECT_NEAR(length() - back, 500.0, 1.0);
  flying.start = Eigen::Vector3d(-500, 0, 5);
  EXPECT_THAT(findings(items, flying), Contains(HasSubstr("2500 m from the place before")));
}

TEST(MissionCheck, ATakeoffIsHeldToTheFence) {
  MissionCheckParams params;
  params.fence = {0, 5};
  EXPECT_THAT(findings({takeoff_to(5), kDown}, params), IsEmpty());
  EXPECT_THAT(findings({takeoff_to(6), kDown}, params),
              ElementsAre(HasSubstr("item 1: error: it is at 6.0 m, 1.0 m above the fence")));
}

TEST(MissionCheck, WhatIsFasterThanTheVehicleFliesIsSlowedDown) {
  MissionCheckParams params = params_with_origin();
  params.flown_speed = 3.0;
  const MissionItem fast = with_speed(earth_at(60, 0, 5), 6.0);
  EXPECT_THAT(findings({kUp, fast, kBack}, params),
              ElementsAre(AllOf(HasSubstr("item 2: warning: its speed of 6 m/s"),
                                HasSubstr("will be 3 m/s"))));
  const auto duration = [&params](const MissionItem& item) {
    return check_mission(mission_of({kUp, item, kDown}), params).duration;
  };
  EXPECT_EQ(duration(fast), duration(with_speed(fast, 3.0)));
}

TEST(MissionCheck, TheVehicleTakesSoManyItems) {
  MissionCheckParams params;
  params.most_items = 3;
  EXPECT_THAT(findings({kUp, hold_for(1), kBack}, params), IsEmpty());
  EXPECT_THAT(findings({kUp, hold_for(1), hold_for(1), kBack}, params),
              ElementsAre(HasSubstr("m: error: it has 4 items, and the vehicle takes 3")));
}

TEST(MissionCheck, ItemsThatMakeNoSenseAreNamed) {
  EXPECT_THAT(findings({takeoff_to(0), hold_for(-1), kDown}),
              ElementsAre(HasSubstr("item 1: error: a take-off to 0 m"),
                          HasSubstr("item 2: error: a hold of -1 s")));
}

TEST(MissionCheck, TheFenceIsACylinderAroundTheTakeoffPoint) {
  MissionCheckParams params = params_with_origin();
  params.takeoff = {10, 20, 0};
  params.fence = {50, 12};
  // On the circle within a centimetre, by both kinds of waypoints.
  for (const double beyond : {-0.01, 0.01}) {
    const MissionItem inside = in_map(10 + 50 + beyond, 20, 1);
    const MissionItem outside = earth_at(10, 20 - 50 - beyond, 5);
    EXPECT_EQ(findings({kUp, inside, kBack}, params).size(), beyond > 0 ? 1u : 0u);
    EXPECT_EQ(findings({kUp, outside, kBack}, params).size(), beyond > 0 ? 1u : 0u);
  }
  EXPECT_THAT(
      findings({kUp, in_map(70, 20, 13), kBack}, params),
      ElementsAre(
          HasSubstr("item 2: error: it is at 13.0 m, 1.0 m above the fence of 12.0 m"),
          HasSubstr("item 2: error: it is 60.0 m from the take-off point, 10.0 m outside")));
  EXPECT_THAT(findings({kUp, earth_at(10, 20, 0), kBack}, params),
              ElementsAre(HasSubstr("at 15.2 m")))
      << "the usual altitude";
  params.origin.reset();
  EXPECT_THAT(
      findings({kUp, earth_at(500, 20, 5), kBack}, params),
      ElementsAre(HasSubstr("the way to it is not checked"), HasSubstr("radius is not checked")));
}

TEST(MissionCheck, HomeSaysWhereTheMapIs) {
  MissionFile mission = mission_of({kUp, earth_at(60, 0, 5), kBack});
  mission.home = kOrigin.to_global({0, 0, 0});
  MissionCheckParams params;
  params.fence.radius = 50;
  EXPECT_THAT(texts(check_mission(mission, params)), ElementsAre(HasSubstr("10.0 m outside")));
  // Another take-off point in the map is the same on Earth.
  params.takeoff = {-300, 200, 0};
  EXPECT_THAT(texts(check_mission(mission, params)), ElementsAre(HasSubstr("10.0 m outside")));
}

TEST(MissionCheck, SpeedsAndDistancesHaveLimits) {
  MissionCheckParams params = params_with_origin();
  params.most_speed = 4.0;
  EXPECT_THAT(
      findings({kUp, with_speed(earth_at(50, 0, 5), 4.5), with_speed(earth_at(0, 0, 5), 4), kBack},
               params),
      ElementsAre(HasSubstr("item 2: error: its speed of 4.5 m/s is above the limit of 4 m/s")));
  EXPECT_THAT(findings({kUp, earth_at(1001, 0, 1.2), kBack}, params),
              ElementsAre(HasSubstr("it is 1001 m from")));
  EXPECT_THAT(findings({kUp, earth_at(999, 0, 1.2), kBack}, params), IsEmpty());
  EXPECT_THAT(findings({kUp, in_map(1, 0, 1), in_map(1, 0.04, 1), kBack}),
              ElementsAre(HasSubstr("item 3: warning: it is 0.04 m")));
  MissionItem turn = in_map(1, 0, 1);
  turn.place.yaw = 1.0;
  EXPECT_THAT(findings({kUp, in_map(1, 0, 1), turn, kBack}), IsEmpty()) << "it turns there";
}

TEST(MissionCheck, TheFenceOfTheFileHoldsForWholeLegs) {
  const auto corner = [](double x, double y) { return kOrigin.to_global({x, y, 0}); };
  MissionFile mission =
      mission_of({kUp, earth_at(40, 0, 5), earth_at(40, 40, 5), earth_at(0, 40, 5), kBack});
  const MissionCheckParams params = params_with_origin();
  FenceZone stay;
  stay.centre = corner(20, 20);
  stay.radius = 29;
  mission.fence = {stay};
  EXPECT_THAT(texts(check_mission(mission, params)), IsEmpty()) << "28.3 m from its middle at most";
  FenceZone off;  // a triangle across the leg from 40, 0 to 40, 40, which has no waypoint in it
  off.stay_inside = false;
  off.corners = {corner(38, 20), corner(45, 15), corner(45, 25)};
  off.line = 77;
  mission.fence = {stay, off};
  EXPECT_THAT(
      texts(check_mission(mission, params)),
      ElementsAre(AllOf(HasSubstr("item 3: error"), HasSubstr("area to stay out of (line 77)"))));
  mission.fence[0].radius = 28;
  EXPECT_EQ(texts(check_mission(mission, params)).size(), 4u) << "each leg, once";
}

/// Ten metres by ten, free, with a wall 20 cm thick at x = 5 m from y = 0 to 8 m.
OccupancyGrid room() {
  OccupancyGrid::Params params;
  params.resolution = 0.1;
  OccupancyGrid grid(params, {0, 0}, 100, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      grid.set_state({x, y},
                     (x == 50 || x == 51) && y < 80 ? CellState::kOccupied : CellState::kFree);
    }
  }
  return grid;
}

TEST(MissionCheck, WaypointsKeepClearOfObstacles) {
  const OccupancyGrid grid = room();
  MissionCheckParams params = params_with_origin();
  params.map = &grid;
  params.takeoff = {2, 2, 0};
  params.clearance = 0.3;
  EXPECT_THAT(findings({kUp, in_map(8, 2, 1.2), kBack}, params), IsEmpty())
      << "the planner goes around";
  EXPECT_THAT(findings({kUp, in_map(5.1, 2, 1.2), kBack}, params),
              ElementsAre(HasSubstr("item 2: error: x 5.10, y 2.00 is inside an obstacle")));
  EXPECT_THAT(findings({kUp, in_map(4.8, 2, 1.2), kBack}, params),
              ElementsAre(HasSubstr("the vehicle needs 0.30 m")));
  EXPECT_THAT(findings({kUp, in_map(4.6, 2, 1.2), kBack}, params), IsEmpty());
  EXPECT_THAT(findings({kUp, in_map(12, 2, 1.2), kBack}, params),
              ElementsAre(HasSubstr("warning: x 12.00, y 2.00 is not known")));
  EXPECT_THAT(findings({kUp, in_map(5.1, 2, 5), kBack}, params), IsEmpty())
      << "above what the map is of";
}

TEST(MissionCheck, AStraightLegDoesNotGoThroughAWall) {
  const OccupancyGrid grid = room();
  MissionCheckParams params = params_with_origin();
  params.clearance = 0.25;
  params.map = &grid;
  params.takeoff = {2, 2, 0};
  EXPECT_THAT(
      findings({kUp, earth_at(8, 2, 1.2), in_map(8, 9, 1.2), kDown}, params),
      ElementsAre(AllOf(HasSubstr("item 2: error"), HasSubstr("at x 4.8"), HasSubstr("y 2.00"))));
  EXPECT_THAT(findings({kUp, earth_at(2, 9, 1.2), earth_at(8, 9, 1.2), kDown}, params), IsEmpty());
  EXPECT_THAT(findings({kUp, earth_at(8, 2, 10), kDown}, params), IsEmpty()) << "above it";
  EXPECT_THAT(
      findings({kUp, earth_at(2, 9, 1.2), earth_at(8, 9, 1.2), earth_at(8, 2, 1.2), kBack}, params),
      ElementsAre(HasSubstr("item 5: error: its straight way is not clear")))
      << "the way back is straight too";
  // From far off, through the whole map.
  EXPECT_THAT(findings({kUp, earth_at(2, 200, 1.2), kDown}, params).size(), 1u)
      << "its end is not known";
  EXPECT_THAT(findings({kUp, earth_at(-300, 5, 1.2), earth_at(300, 5, 1.2), kDown}, params),
              ElementsAre(HasSubstr("item 2: warning"), HasSubstr("item 3: warning"),
                          AllOf(HasSubstr("item 3: error"), HasSubstr("at x 4.8"))));
}

TEST(MissionCheck, ItsTimeIsThatOfLegsClimbsHoldsAndTheWayHome) {
  MissionCheckParams params;
  params.climb_speed = 0.5;
  params.descent_speed = 0.25;
  params.indoor_speed = 1.0;
  params.acceleration = 1.0;
  // 2 s up, 10 m at 1 m/s with 1 s for both ramps, 30 s, the same back, 4 s down.
  const MissionFile whole = mission_of({takeoff_to(1), in_map(10, 0, 1), hold_for(30), kBack});
  EXPECT_NEAR(check_mission(whole, params).duration, 2 + 11 + 30 + 11 + 4, 1e-9);
  EXPECT_NEAR(check_mission(whole, params).length, 20, 1e-9);
  // Who ends in the air has to come back as well.
  const MissionFile open = mission_of({takeoff_to(1), in_map(10, 0, 1), hold_for(30)});
  EXPECT_NEAR(check_mission(open, params).duration, 58, 1e-9);
}

TEST(MissionCheck, TheBatteryReachesToTheEnd) {
  MissionCheckParams params;
  const std::vector<MissionItem> items{kUp, in_map(10, 0, 1.2), hold_for(100), in_map(20, 0, 1.2),
                                       kBack};
  const double needed = check_mission(mission_of(items), params).duration;
  params.charge = 0.9;
  params.reserve = 0.4;
  params.endurance = 2.0 * (needed + 0.01);
  EXPECT_THAT(findings(items, params), IsEmpty());
  params.endurance = 2.0 * (needed - 0.01);
  EXPECT_THAT(findings(items, params),
              ElementsAre(HasSubstr("item 4: warning: from here it cannot come home"),
                          AllOf(HasSubstr("item 5: error"), HasSubstr("reserve of 40 %"))));
  params.endurance = 2.0 * 50;
  EXPECT_THAT(findings(items, params), ElementsAre(HasSubstr("item 3: error: it ends after")))
      << "said once, where it happens";
}

TEST(MissionCheck, AnErrorOfBeforeForgivesOneOfItsKind) {
  MissionCheckParams params = params_with_origin();
  params.fence.height = 50.0;
  const auto change = [&params](const std::vector<MissionItem>& before,
                                const std::vector<MissionItem>& after) {
    return check_change(mission_of(before), mission_of(after), params);
  };
  const MissionItem high = earth_at(10, 0, 60.0), higher = earth_at(10, 0, 70.0);
  const std::vector<MissionItem> before{kUp, high, kBack};
  ASSERT_TRUE(check_mission(mission_of(before), params).has_errors());
  EXPECT_FALSE(change(before, {kUp, earth_at(5, 5, 10.0), high, kBack}).has_errors());
  EXPECT_FALSE(change(before, {kUp, higher, kBack}).has_errors()) << "the same one, changed";
  EXPECT_TRUE(change(before, {kUp, high, high, kBack}).has_errors())
      << "another one with the same text is not forgiven";
  EXPECT_FALSE(change(before, {kUp, earth_at(10, 0, 40.0), kBack}).has_errors()) << "mended";
  const MissionCheck other = change(before, {high, kBack});
  EXPECT_TRUE(other.has_errors()) << "an error of another kind: no take-off";
  // What is too long can be made shorter, although its numbers change.
  params = {};
  params.endurance = 30.0;
  const std::vector<MissionItem> longer{kUp, hold_for(60), hold_for(60), kBack};
  EXPECT_FALSE(change(longer, {kUp, hold_for(60), kBack}).has_errors());
}

TEST(MissionCheck, AnyMissionIsCheckedTheSameTwice) {
  MissionMaker maker(6);
  const OccupancyGrid grid = room();
  for (int round = 0; round < 200; ++round) {
    const MissionFile mission = maker.mission(true);
    MissionCheckParams params;
    params.map = &grid;
    params.fence = {50, 50};
    params.endurance = 600;
    params.most_speed = 10;
    const MissionCheck check = check_mission(mission, params);
    EXPECT_EQ(texts(check), texts(check_mission(mission, params)));
    EXPECT_TRUE(std::isfinite(check.duration));
    // By item, the whole mission's last.
    EXPECT_TRUE(
        std::is_sorted(check.findings.begin(), check.findings.end(),
                       [](const auto& a, const auto& b) { return a.item - 1 < b.item - 1; }));
  }
}

}  // namespace
}  // namespace swiftlet
