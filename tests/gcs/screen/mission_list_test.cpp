// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/mission_list.hpp"

#include <gmock/gmock.h>

#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/panels.hpp"
#include "gcs/screen/screen_painter.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using Kind = MissionItem::Kind;

constexpr const char* kEverything = R"(mission:
  name: "everything"
  cruise_speed: 2
home: {latitude: 47.4, longitude: 8.5, altitude: 450}
fence:
  - {stay: inside, latitude: 47.4, longitude: 8.5, radius: 120}
items:
  - takeoff: 1.4
  - goto: {x: 3, y: 1.5, z: 1.2, yaw_deg: 90, hold: 2}
  - claw: close
  - gps: {latitude: 47.4001, longitude: 8.5002, altitude: 10, speed: 3}
  - hold: 5
  - claw: open
  - return
)";

MissionFile everything() {
  auto mission = parse_mission(MissionForm::kYaml, kEverything, "everything.yaml");
  EXPECT_TRUE(mission.ok()) << mission.error().reason;
  return *mission;
}

const LocalOrigin kOrigin({47.4, 8.5, 450.0});

TEST(MissionList, KeepsAllThatAFileSays) {
  MissionList list;
  list.replace(everything());
  EXPECT_EQ(format_mission(MissionForm::kYaml, list.mission())->text, kEverything);
  // An edit of one changes nothing else.
  list.append({0.0, 0.0, 1.0});
  list.remove();
  EXPECT_EQ(format_mission(MissionForm::kYaml, list.mission())->text, kEverything);
}

TEST(MissionList, ShowsEachItem) {
  Controller controller;
  controller.waypoints().replace(everything());
  const auto screen_of = [&](int width, const std::optional<LocalOrigin>& origin) {
    Surface surface(width, 12);
    paint_waypoints(Pane(surface), controller, origin);
    return to_text(surface);
  };
  const std::string wide = screen_of(38, std::nullopt);
  for (const char* text :
       {"1 take off to 1.4 m", "2   3.00   1.50  1.2 90° hold 2 s", "3 close the claw",
        "4 gps 47.40010 8.50020 10 m 3 m/s", "5 hold 5 s", "6 open the claw", "7 return"}) {
    EXPECT_THAT(wide, HasSubstr(text));
  }
  EXPECT_THAT(wide, HasSubstr("not on the map"));
  EXPECT_THAT(screen_of(38, kOrigin), Not(HasSubstr("not on the map")));
  // With little room a place on Earth is told as one in the map, where that is known.
  const std::string narrow = screen_of(22, kOrigin);
  EXPECT_THAT(narrow, HasSubstr("2   3.00   1.50  1.2\n    90° hold 2 s\n"));
  EXPECT_THAT(narrow, HasSubstr("4 gps 15.1 11.1\n    10 m 3 m/s\n"));
}

TEST(MissionList, PlacesOnEarthAreOnTheMapWhereItsOriginIsKnown) {
  const MissionFile mission = everything();
  const MissionItem& gps = mission.items[3].item;
  EXPECT_FALSE(place_in_map(gps, std::nullopt));
  const Eigen::Vector2d expected =
      kOrigin.to_map({gps.global->latitude, gps.global->longitude, 450.0}).head<2>();
  ASSERT_TRUE(place_in_map(gps, kOrigin));
  EXPECT_LT((*place_in_map(gps, kOrigin) - expected).norm(), 1e-6);
  EXPECT_FALSE(place_in_map(mission.items[4].item, kOrigin)) << "a hold is nowhere";
}

TEST(MissionList, APlaceOnEarthMovesThereAndBack) {
  MissionList list;
  list.replace(everything());
  list.select(3);
  EXPECT_THAT(list.move_to({5.0, -7.0}, std::nullopt).error().reason, HasSubstr("GPS fix"));
  ASSERT_TRUE(list.move_to({5.0, -7.0}, kOrigin).ok());
  EXPECT_LT((*place_in_map(*list.current(), kOrigin) - Eigen::Vector2d(5.0, -7.0)).norm(), 1e-3);
  EXPECT_EQ(list.current()->global->altitude, 10.0);
  EXPECT_EQ(list.current()->place.speed, 3.0);
  list.select(4);
  EXPECT_THAT(list.move_to({5.0, -7.0}, kOrigin).error().reason, HasSubstr("item 5 has no place"));
}

TEST(MissionList, HeightsAreThoseThatAnItemHas) {
  MissionList list;
  EXPECT_FALSE(list.height());
  list.replace(everything());
  EXPECT_EQ(list.height(), 1.4);
  list.set_height(2.0);
  EXPECT_EQ(list.current()->altitude, 2.0);
  list.select(3);
  list.set_height(20.0);
  EXPECT_EQ(list.current()->global->altitude, 20.0);
  list.select(4);
  EXPECT_FALSE(list.height());
  list.set_height(3.0);
  EXPECT_EQ(list.current()->hold, 5.0);
  EXPECT_EQ(list.height_nearby(), 1.2) << "of the waypoint in the map before it";
  list.select(0);
  EXPECT_EQ(list.height_nearby(), 1.2) << "of the one behind it";
}

TEST(MissionList, KnowsWhetherAnEditWouldBeLost) {
  MissionList list;
  EXPECT_TRUE(list.is_kept());
  list.append({1.0, 2.0, 3.0});
  EXPECT_FALSE(list.is_kept());
  list.set_kept("a.yaml");
  EXPECT_TRUE(list.is_kept());
  EXPECT_EQ(list.file(), "a.yaml");
  list.select_previous();
  EXPECT_TRUE(list.is_kept());
  list.set_height(1.0);
  EXPECT_FALSE(list.is_kept());
  EXPECT_EQ(list.file(), "a.yaml");
  list.replace(everything());
  EXPECT_EQ(list.file(), "") << "it is another mission";
}

TEST(Entry, ShowsTheEndOfALongName) {
  Controller controller;
  GroundStationModel model;
  MapPicture picture;
  Surface surface(80, 24);
  for (const char c : std::string("wo/a/long/way/down/into/some/folder/of/folders/where/there/is/a/"
                                  "mission/called/yard.plan")) {
    controller.press(key_code(static_cast<unsigned char>(c)), {});
  }
  paint(surface, model, controller, picture, Time(1s));
  EXPECT_THAT(to_text(surface), HasSubstr("Open which file? …"));
  EXPECT_THAT(to_text(surface), HasSubstr("/called/yard.plan_"));
}

}  // namespace
}  // namespace swiftlet::screen
