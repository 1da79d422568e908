// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = MissionItem::Kind;

constexpr MissionForm kPlan = MissionForm::kPlan;

std::string yard() {
  return text_of_file(mission_data("yard.plan"));
}

/// The plan of the yard with one piece of text in place of another.
std::string yard_with(const std::string& piece, const std::string& other) {
  std::string text = yard();
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), other);
}

std::string remark_at(const MissionFile& mission, int line) {
  for (const MissionRemark& remark : mission.remarks) {
    if (remark.line == line) return remark.text;
  }
  return "";
}

/// In which line of the yard a piece of text stands.
int line_of(const std::string& piece) {
  const std::string text = yard();
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find(piece));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

TEST(PlanMission, AllThatIsSupportedIsThere) {
  const auto mission = read_mission(mission_data("yard.plan"));
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  const std::vector<MissionItem> items = items_of(*mission);
  ASSERT_EQ(items.size(), 11u);
  EXPECT_EQ(items[0].kind, Kind::kTakeoff);
  EXPECT_EQ(items[0].altitude, 12.0);
  EXPECT_EQ(items[1].global->latitude, 47.398);
  EXPECT_EQ(items[1].global->altitude, 15.0);
  EXPECT_EQ(items[1].hold, 2.5);
  EXPECT_EQ(items[1].place.yaw, 0.0) << "90 degrees clockwise from north is east";
  EXPECT_EQ(items[1].place.speed, 3.5);
  EXPECT_EQ(items[2].global->altitude, 20.0) << "508.5 m above sea, and home is at 488.5 m";
  EXPECT_FALSE(items[2].place.yaw);
  EXPECT_EQ(items[2].place.speed, 3.5) << "as the waypoint before";
  EXPECT_EQ(items[3].hold, 7.0);
  EXPECT_EQ(items[4].global->latitude, 47.3983);
  EXPECT_FALSE(items[4].place.speed) << "back to the usual speed";
  EXPECT_TRUE(items[5].open);
  EXPECT_EQ(items[6].kind, Kind::kClaw);
  EXPECT_FALSE(items[6].open);
  EXPECT_EQ(items[7].global->latitude, 47.3984) << "of the survey";
  EXPECT_EQ(items[8].global->latitude, 47.3985);
  EXPECT_EQ(items[9].global->latitude, 47.3978) << "the landing's place";
  EXPECT_EQ(items[9].global->altitude, 30.0) << "at the height of the item before";
  EXPECT_EQ(items[10].kind, Kind::kLand);
  EXPECT_EQ(mission->cruise_speed, 4.5);
  EXPECT_EQ(mission->home->altitude, 488.5);
  ASSERT_EQ(mission->fence.size(), 2u);
  EXPECT_EQ(mission->fence[0].radius, 300.0);
  EXPECT_EQ(mission->fence[1].corners.size(), 3u);
  EXPECT_EQ(mission->items[1].line, line_of("\"command\": 16,"));
}

TEST(PlanMission, WhatIsNotSupportedIsSaidWithItsLine) {
  const auto mission = read_mission(mission_data("yard.plan"));
  ASSERT_TRUE(mission.ok());
  EXPECT_THAT(remark_at(*mission, line_of("\"command\": 206")),
              HasSubstr("DO_SET_CAM_TRIGG_DIST (206): not"));
  EXPECT_THAT(remark_at(*mission, line_of("508.5") - 1), HasSubstr("above sea"));
  EXPECT_THAT(remark_at(*mission, line_of("\"command\": 17,")), HasSubstr("LOITER_UNLIM"));
  EXPECT_THAT(remark_at(*mission, line_of("StructureScan")), HasSubstr("left out"));
  EXPECT_THAT(remark_at(*mission, line_of("rallyPoints")), HasSubstr("not supported"));
  EXPECT_THAT(remark_at(*mission, line_of("geoFence")), HasSubstr("the vehicle is not told"));
  const bool says_terrain = std::any_of(
      mission->remarks.begin(), mission->remarks.end(),
      [](const auto& remark) { return remark.text.find("terrain") != std::string::npos; });
  EXPECT_TRUE(says_terrain);
}

TEST(PlanMission, ErrorsNameTheLine) {
  const auto error = [](const std::string& piece, const std::string& other) {
    return error_of(kPlan, yard_with(piece, other));
  };
  const auto at = [](const std::string& piece) { return fmt::format("m:{}: ", line_of(piece)); };
  const std::string waypoint = "[2.5, 0, 0, 90, 47.398, 8.5457, 15]";
  EXPECT_THAT(error(waypoint, "[2.5, 0, 0, 90, 47.398, 8.5457]"),
              AllOf(HasSubstr(at(waypoint)), HasSubstr("6 numbers, not 7")));
  EXPECT_THAT(error(waypoint, "[2.5, 0, 0, 90, 147.398, 8.5457, 15]"),
              AllOf(HasSubstr(fmt::format("m:{}: ", line_of(waypoint) - 1)),
                    HasSubstr("item 2: 147.398, 8.5457 is no place on Earth")));
  EXPECT_THAT(error(waypoint, "[2.5, 0, 0, 90, 0, 0, 15]"), HasSubstr("no place"));
  EXPECT_THAT(error(waypoint, "[2.5, 0, 0, 90, 47.398, 8.5457, null]"), HasSubstr("no altitude"));
  EXPECT_THAT(error(waypoint, "[2.5, 0, 0, 90, 47.398, 8.5457, -3]"),
              HasSubstr("-3 m cannot be flown"));
  EXPECT_THAT(error(waypoint, "[9999, 0, 0, 90, 47.398, 8.5457, 5]"),
              HasSubstr("a hold of 9999 s"));
  EXPECT_THAT(error(waypoint, "[\"2\", 0, 0, 90, 47.398, 8.5457, 5]"),
              HasSubstr("expected a number, found '2'"));
  EXPECT_THAT(error(waypoint, "[1e999, 0, 0, 90, 47.398, 8.5457, 5]"), HasSubstr(at(waypoint)));
  EXPECT_THAT(error("\"command\": 211,", "\"comand\": 211,"),
              AllOf(HasSubstr(at("\"command\": 211,")), HasSubstr("'command' is missing")));
  EXPECT_THAT(error("\"hoverSpeed\": 4.5,", "\"hoverSpeed\": 4.5"), HasSubstr("not valid JSON"));
  EXPECT_THAT(error("\"hoverSpeed\": 4.5,", "\"hoverSpeed\": 4.5, \"hoverSpeed\": 5,"),
              AllOf(HasSubstr(at("hoverSpeed")), HasSubstr("given twice")));
  EXPECT_THAT(error("\"fileType\": \"Plan\"", "\"fileType\": \"Paln\""), HasSubstr("'Paln'"));
  EXPECT_THAT(
      error("\"plannedHomePosition\": [47.3977, 8.5456, 488.5],", ""),
      AllOf(HasSubstr(at("\"frame\": 0")), HasSubstr("above sea"), HasSubstr("--home-altitude")));
  EXPECT_THAT(error("8.5456, 488.5]", "8.5456, null]"), HasSubstr("--home-altitude"));
  EXPECT_THAT(error("[1, 3.5, -1, 0, 0, 0, 0]", "[1, 0, -1, 0, 0, 0, 0]"), HasSubstr("above 0"));
  EXPECT_THAT(error("\"frame\": 0,", "\"frame\": 1,"),
              HasSubstr("frame 1, which is not supported"));
}

TEST(PlanMission, WrittenAndReadAgainItIsTheSame) {
  MissionMaker maker(3);
  for (int round = 0; round < 300; ++round) {
    const MissionFile mission = maker.mission(false);
    const auto text = format_mission(kPlan, mission);
    ASSERT_TRUE(text.ok()) << text.error().reason;
    const auto again = parse_mission(kPlan, text->text, "again.plan");
    ASSERT_TRUE(again.ok()) << again.error().reason << "\n" << text->text;
    expect_same_items(*again, mission, 1e-15);
    expect_same_fence(*again, mission);
    EXPECT_EQ(again->cruise_speed, mission.cruise_speed);
    EXPECT_EQ(again->home->altitude, mission.home->altitude);
    if (HasFailure()) FAIL() << text->text;
  }
}

TEST(PlanMission, WhatAFormCannotHoldIsRefusedWithItsItem) {
  for (const MissionForm form : {kPlan, MissionForm::kWaypoints}) {
    const auto inside = format_mission(form, mission_of({takeoff_to(1), in_map(1, 2, 1)}));
    ASSERT_FALSE(inside.ok());
    EXPECT_THAT(inside.error().reason,
                AllOf(HasSubstr("item 2 (line 2)"), HasSubstr("write .yaml")));
    const auto low = format_mission(form, mission_of({on_earth(1, 2, 0)}));
    ASSERT_FALSE(low.ok());
    EXPECT_THAT(low.error().reason, HasSubstr("no altitude"));
    EXPECT_FALSE(format_mission(form, mission_of({takeoff_to(1)})).ok()) << "nobody knows where";
    MissionFile named = mission_of({takeoff_to(1), on_earth(1, 2, 3)});
    named.name = "a name";
    EXPECT_EQ(format_mission(form, named)->losses.size(), 2u) << "the name, and home is a guess";
  }
}

}  // namespace
}  // namespace swiftlet
