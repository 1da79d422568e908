// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = MissionItem::Kind;

constexpr MissionForm kWaypoints = MissionForm::kWaypoints;

std::string list_of(const std::vector<std::string>& lines) {
  std::string text = "QGC WPL 110\n";
  std::size_t index = 0;
  for (const std::string& line : lines) text += fmt::format("{}\t0\t{}\n", index++, line);
  return text;
}

TEST(WaypointsMission, TheFirstItemIsHomeWhereItIsAWaypointAboveSea) {
  const auto mission = read_mission(mission_data("yard.waypoints"));
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  ASSERT_TRUE(mission->home);
  EXPECT_EQ(mission->home->altitude, 488.5);
  const std::vector<MissionItem> items = items_of(*mission);
  ASSERT_EQ(items.size(), 6u);
  EXPECT_EQ(items[0].altitude, 12.0);
  EXPECT_EQ(mission->items[0].line, 3);
  EXPECT_EQ(items[1].place.speed, 3.5);
  EXPECT_EQ(items[1].place.yaw, 0.0) << "90 degrees clockwise from north is east";
  EXPECT_EQ(items[1].hold, 2.5);
  EXPECT_FALSE(items[2].place.yaw) << "0 is none here";
  EXPECT_EQ(items[3].hold, 6.0);
  EXPECT_TRUE(items[4].open);
  EXPECT_EQ(items[5].kind, Kind::kReturn);
  // Relative to home it is no home.
  const auto other = parse_mission(kWaypoints, list_of({"3\t16\t0\t0\t0\t0\t47\t8\t10\t1"}), "m");
  ASSERT_TRUE(other.ok());
  EXPECT_FALSE(other->home);
  EXPECT_EQ(other->items.size(), 1u);
}

TEST(WaypointsMission, ErrorsNameTheLine) {
  const std::string good = "3\t22\t0\t0\t0\t0\t0\t0\t12\t1";
  const auto error = [&](const std::string& second) {
    return error_of(kWaypoints, list_of({good, second}));
  };
  EXPECT_EQ(error(good), "");
  EXPECT_THAT(error_of(kWaypoints, "QGC WPL 120\n"),
              AllOf(HasSubstr("m:1:"), HasSubstr("QGC WPL 110")));
  EXPECT_THAT(error_of(kWaypoints, ""), HasSubstr("m:1:"));
  EXPECT_THAT(error_of(kWaypoints, "QGC WPL 110\n"), HasSubstr("no items"));
  EXPECT_THAT(error("3\t22\t0\t0\t0\t0\t0\t0\t12"),
              AllOf(HasSubstr("m:3:"), HasSubstr("11 columns, not 12")));
  EXPECT_THAT(error("3\t16\t0\t0\t0\tnorth\t47\t8\t12\t1"),
              AllOf(HasSubstr("m:3:"), HasSubstr("'north'")));
  EXPECT_THAT(error("3\t16\t0\t0\t0\t0\t1e999\t8\t12\t1"), HasSubstr("m:3:"));
  EXPECT_THAT(error("3\t16\t0\t0\t0\t0\tnan\t8\t12\t1"), HasSubstr("no place"));
  EXPECT_THAT(error("0\t16\t0\t0\t0\t0\t47\t8\t500\t1"),
              AllOf(HasSubstr("m:3:"), HasSubstr("--home-altitude")));
  EXPECT_THAT(error("3\t16.5\t0\t0\t0\t0\t47\t8\t12\t1"), HasSubstr("whole number"));
  std::string gap = list_of({good, good, good});
  gap.replace(gap.find("1\t0\t3"), 1, "7");
  EXPECT_THAT(error_of(kWaypoints, gap), AllOf(HasSubstr("m:3:"), HasSubstr("is a line missing?")));
}

TEST(WaypointsMission, AltitudesAboveSeaNeedSomebodyWhoKnowsHome) {
  const std::string text =
      list_of({"5\t22\t0\t0\t0\t0\t47\t8\t515\t1", "0\t16\t0\t0\t0\t0\t47\t8\t520\t1"});
  EXPECT_NE(error_of(kWaypoints, text), "");
  const auto mission = parse_mission(kWaypoints, text, "m", MissionReading{500.0});
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  EXPECT_EQ(mission->items[0].item.altitude, 15.0);
  EXPECT_EQ(mission->items[1].item.global->altitude, 20.0);
}

TEST(WaypointsMission, WrittenAndReadAgainItIsTheSame) {
  MissionMaker maker(4);
  for (int round = 0; round < 300; ++round) {
    const MissionFile mission = maker.mission(false);
    const auto text = format_mission(kWaypoints, mission);
    ASSERT_TRUE(text.ok());
    const auto again = parse_mission(kWaypoints, text->text, "again.waypoints");
    ASSERT_TRUE(again.ok()) << again.error().reason << "\n" << text->text;
    expect_same_items(*again, mission, 1e-15);
    EXPECT_EQ(again->home->latitude, mission.home->latitude);
    if (HasFailure()) FAIL() << text->text;
  }
}

TEST(WaypointsMission, NorthIsAHeadingAndNoneIsNone) {
  MissionFile mission = mission_of({on_earth(47, 8, 10), on_earth(47, 8.001, 10)});
  mission.items[0].item.place.yaw = kTurn / 4;
  for (const MissionForm form : {kWaypoints, MissionForm::kPlan}) {
    const auto again = parse_mission(form, format_mission(form, mission)->text, "m");
    ASSERT_TRUE(again.ok());
    EXPECT_DOUBLE_EQ(again->items[0].item.place.yaw.value_or(0), kTurn / 4);
    EXPECT_FALSE(again->items[1].item.place.yaw);
  }
}

}  // namespace
}  // namespace swiftlet
