// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Files that QGroundControl and others wrote.
#include <algorithm>

#include "tests/data_folder.hpp"
#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = MissionItem::Kind;

std::filesystem::path sample(const std::string& name) {
  return data_folder() / "missions" / name;
}

std::size_t count_remarks(const MissionFile& mission, const std::string& piece) {
  return static_cast<std::size_t>(std::count_if(
      mission.remarks.begin(), mission.remarks.end(),
      [&](const auto& remark) { return remark.text.find(piece) != std::string::npos; }));
}

TEST(SampleMissions, APlanIsReadWhole) {
  const auto file = sample("qgroundcontrol_sample.plan");
  SWIFTLET_SKIP_WITHOUT(file);
  const auto mission = read_mission(file);
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  const std::vector<MissionItem> items = items_of(*mission);
  ASSERT_EQ(items.size(), 5u);
  EXPECT_EQ(items[0].altitude, 50.0);
  EXPECT_EQ(items[1].global->longitude, 8.5466122);
  EXPECT_EQ(items[2].global->latitude, 47.39827377);
  EXPECT_EQ(items[3].global->altitude, 50.0);
  EXPECT_EQ(items[4].kind, Kind::kReturn);
  EXPECT_EQ(mission->cruise_speed, 5.0) << "hovering, not on wings";
  EXPECT_EQ(mission->items[1].line, 36);
  ASSERT_EQ(mission->remarks.size(), 1u);
  EXPECT_EQ(mission->remarks[0].line, 55);
  EXPECT_THAT(mission->remarks[0].text, HasSubstr("IMAGE_START_CAPTURE (2000)"));
}

TEST(SampleMissions, ASurveyIsFlownAsItsWaypoints) {
  const auto file = sample("qgroundcontrol_sample_with_survey.plan");
  SWIFTLET_SKIP_WITHOUT(file);
  const auto mission = read_mission(file);
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  EXPECT_EQ(mission->items.size(), 8u) << "as many as it has points to turn and shoot at";
  for (const WrittenItem& written : mission->items) {
    ASSERT_TRUE(written.item.global);
    EXPECT_EQ(written.item.global->altitude, 50.0);
  }
  EXPECT_EQ(mission->items[0].item.global->latitude, 47.397705960554916);
  EXPECT_EQ(count_remarks(*mission, "SET_CAMERA_MODE (530)"), 1u);
  EXPECT_EQ(count_remarks(*mission, "DO_SET_CAM_TRIGG_DIST (206)"), 4u);
  EXPECT_EQ(count_remarks(*mission, "survey: flown as"), 1u);
  EXPECT_EQ(mission->remarks.size(), 6u);
}

TEST(SampleMissions, WhatIsNoMissionIsRefused) {
  const auto without = sample("qgroundcontrol_sample_without_mission.plan");
  SWIFTLET_SKIP_WITHOUT(without);
  const auto none = read_mission(without);
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().reason, AllOf(HasSubstr(".plan:1: "), HasSubstr("no 'mission'")));
  const auto wrong = read_mission(sample("qgroundcontrol_sample_wrong_overall_version.plan"));
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().reason, AllOf(HasSubstr(".plan:60: "), HasSubstr("version 42")));
}

TEST(SampleMissions, AListWithAltitudesAboveSeaWantsToKnowHome) {
  const auto file = sample("mission_planner_sample.waypoints");
  SWIFTLET_SKIP_WITHOUT(file);
  const auto unknown = read_mission(file);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().reason,
              AllOf(HasSubstr(".waypoints:2: "), HasSubstr("--home-altitude")));
  const auto mission = read_mission(file, MissionReading{5.0});
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  const std::vector<MissionItem> items = items_of(*mission);
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(items[0].kind, Kind::kTakeoff);
  EXPECT_EQ(items[0].altitude, 10.0);
  EXPECT_EQ(items[1].global->longitude, 8.5454669);
  EXPECT_EQ(items[3].kind, Kind::kReturn);
}

TEST(SampleMissions, GoThroughEveryFormUnchanged) {
  const auto file = sample("qgroundcontrol_sample.plan");
  SWIFTLET_SKIP_WITHOUT(file);
  const auto mission = read_mission(file);
  ASSERT_TRUE(mission.ok());
  for (const MissionForm form : {MissionForm::kYaml, MissionForm::kPlan, MissionForm::kWaypoints}) {
    const auto text = format_mission(form, *mission);
    ASSERT_TRUE(text.ok()) << text.error().reason;
    const auto again = parse_mission(form, text->text, "again");
    ASSERT_TRUE(again.ok()) << again.error().reason;
    expect_same_items(*again, *mission);
  }
}

TEST(Remarks, ThatSayTheSameAreSaidOnce) {
  const auto remarks = merged({{3, "a"}, {4, "b"}, {5, "a"}, {9, "a"}});
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_EQ(remarks[0].line, 3);
  EXPECT_EQ(remarks[0].text, "a (and 2 more like it)");
  EXPECT_EQ(remarks[1].text, "b");
}

}  // namespace
}  // namespace swiftlet
