// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = MissionItem::Kind;

constexpr MissionForm kYaml = MissionForm::kYaml;

/// The block of the README that is a whole mission.
std::string example() {
  const std::string text =
      text_of_file(std::filesystem::path(SWIFTLET_SOURCE_DIR) / "gcs/mission/README.md");
  const std::string begin = "```yaml\n";
  const std::size_t at = text.find(begin) + begin.size();
  return text.substr(at, text.find("```", at) - at);
}

TEST(YamlMission, TheExampleOfTheReadmeIsReadAsItSays) {
  const auto mission = parse_mission(kYaml, example(), "README.md");
  ASSERT_TRUE(mission.ok()) << mission.error().reason;
  EXPECT_EQ(mission->name, "stores and yard");
  EXPECT_EQ(mission->cruise_speed, 2.5);
  ASSERT_TRUE(mission->home);
  EXPECT_EQ(mission->home->altitude, 488.0);
  ASSERT_EQ(mission->fence.size(), 2u);
  EXPECT_EQ(mission->fence[0].radius, 120.0);
  EXPECT_FALSE(mission->fence[1].stay_inside);
  EXPECT_EQ(mission->fence[1].corners.size(), 3u);
  const std::vector<MissionItem> items = items_of(*mission);
  ASSERT_EQ(items.size(), 8u);
  EXPECT_EQ(items[0].altitude, 1.2);
  EXPECT_EQ(items[1].place.position, Eigen::Vector3d(3.0, 1.5, 1.2));
  EXPECT_DOUBLE_EQ(items[1].place.yaw.value(), kTurn / 4);
  EXPECT_EQ(items[1].hold, 2.0);
  EXPECT_EQ(items[2].kind, Kind::kClaw);
  EXPECT_FALSE(items[2].open);
  EXPECT_EQ(items[3].global->latitude, 47.39775);
  EXPECT_EQ(items[3].global->altitude, 10.0);
  EXPECT_EQ(items[3].place.speed, 2.0);
  EXPECT_EQ(items[4].global->altitude, 0.0) << "the usual one";
  EXPECT_EQ(items[5].kind, Kind::kHold);
  EXPECT_TRUE(items[6].open);
  EXPECT_EQ(items[7].kind, Kind::kReturn);
  // Each item knows its line, one behind the other at the end of the file.
  for (std::size_t i = 1; i < 8; ++i) {
    EXPECT_EQ(mission->items[i].line, mission->items[i - 1].line + 1) << i;
  }
}

TEST(YamlMission, WrittenAndReadAgainItIsTheSame) {
  MissionMaker maker(1);
  for (int round = 0; round < 300; ++round) {
    MissionFile mission = maker.mission(true);
    for (std::size_t i = maker.below(6); i > 0; --i) {
      const char* pieces[] = {"a", " ", "\"", "'", "\n", ": ", "#", "ü", "null", "\\", "- ", "\t"};
      mission.name += pieces[maker.below(std::size(pieces))];
    }
    const auto text = format_mission(kYaml, mission);
    ASSERT_TRUE(text.ok());
    EXPECT_TRUE(text->losses.empty());
    const auto again = parse_mission(kYaml, text->text, "again.yaml");
    ASSERT_TRUE(again.ok()) << again.error().reason << "\n" << text->text;
    expect_same_items(*again, mission);
    expect_same_fence(*again, mission);
    EXPECT_EQ(again->name, mission.name);
    EXPECT_EQ(again->cruise_speed, mission.cruise_speed);
    EXPECT_EQ(again->home->latitude, mission.home->latitude);
    EXPECT_EQ(again->home->altitude, mission.home->altitude);
    if (HasFailure()) FAIL() << text->text;
  }
}

TEST(YamlMission, AnyHeadingComesBackWithinARounding) {
  MissionMaker maker(2);
  for (int round = 0; round < 1000; ++round) {
    MissionFile mission = mission_of({in_map(1, 2, 3)});
    mission.items[0].item.place.yaw = maker.number(-7, 7);
    const auto again = parse_mission(kYaml, format_mission(kYaml, mission)->text, "again.yaml");
    ASSERT_TRUE(again.ok());
    EXPECT_DOUBLE_EQ(*again->items[0].item.place.yaw, *mission.items[0].item.place.yaw);
  }
}

TEST(YamlMission, ErrorsNameFileLineAndRemedy) {
  const auto error = [](const std::string& item) {
    return error_of(kYaml, "items:\n  - takeoff: 1.2\n  - " + item + "\n");
  };
  EXPECT_THAT(error("gotoo: {x: 1, y: 2, z: 1}"),
              AllOf(HasSubstr("m:3:"), HasSubstr("'gotoo'"), HasSubstr("did you mean 'goto'")));
  EXPECT_THAT(error("lnd"), AllOf(HasSubstr("m:3:"), HasSubstr("did you mean 'land'")));
  EXPECT_THAT(error("goto: {x: 1, y: 2, z: 1, yaw: 3}"),
              AllOf(HasSubstr("m:3:"), HasSubstr("unknown key 'yaw'"), HasSubstr("yaw_deg")));
  EXPECT_THAT(error("goto: {x: 1, y: 2}"), AllOf(HasSubstr("m:3:"), HasSubstr("'z' is missing")));
  EXPECT_THAT(error("goto: {x: .nan, y: 2, z: 1}"), AllOf(HasSubstr("m:3:"), HasSubstr("finite")));
  EXPECT_THAT(error("goto: {x: north, y: 2, z: 1}"),
              AllOf(HasSubstr("m:3:"), HasSubstr("must be a number, not 'north'")));
  EXPECT_THAT(error("goto: {x: 1e9, y: 2, z: 1}"), HasSubstr("m:3:"));
  EXPECT_THAT(error("gps: {latitude: 91, longitude: 2}"),
              AllOf(HasSubstr("m:3:"), HasSubstr("from -90 to 90, not 91")));
  EXPECT_THAT(error("gps: {latitude: 1, longitude: 2, altitude: 0}"), HasSubstr("positive"));
  EXPECT_THAT(error("gps: {latitude: 1, longitude: 2, speed: 99}"), HasSubstr("99 m/s"));
  EXPECT_THAT(error("hold: -1"), AllOf(HasSubstr("m:3:"), HasSubstr("at least 0, not -1")));
  EXPECT_THAT(error("hold: 1e9"), HasSubstr("m:3:"));
  EXPECT_THAT(error("claw: ajar"), HasSubstr("open or close, not 'ajar'"));
  EXPECT_THAT(error("land: 5"), AllOf(HasSubstr("m:3:"), HasSubstr("write 'land' alone")));
  EXPECT_THAT(error("[land]"), AllOf(HasSubstr("m:3:"), HasSubstr("must be a mapping or a word")));
  EXPECT_THAT(error("{hold: 1, land: }"), HasSubstr("found hold and land"));
  EXPECT_THAT(error("{}"), HasSubstr("found none"));
  EXPECT_EQ(error("land:"), "");
  EXPECT_THAT(error_of(kYaml, "mission: {nam: a}\nitems: [land]\n"),
              AllOf(HasSubstr("m:1:"), HasSubstr("did you mean 'name'")));
  EXPECT_THAT(error_of(kYaml, "mission: {name: a}\n"), HasSubstr("'items' is missing"));
  EXPECT_THAT(error_of(kYaml, "items: []\n"), HasSubstr("no items"));
  EXPECT_THAT(error_of(kYaml, "fence: [{stay: in, latitude: 1, longitude: 2, radius: 3}]\n"),
              HasSubstr("inside or outside, not 'in'"));
}

}  // namespace
}  // namespace swiftlet
