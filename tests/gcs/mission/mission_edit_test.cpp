// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_edit.hpp"

#include <nlohmann/json.hpp>

#include "gcs/mission/mission_text.hpp"
#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Items = std::vector<MissionItem>;

std::vector<std::string> texts(const Items& items) {
  std::vector<std::string> texts;
  for (const MissionItem& item : items) texts.push_back(item_text(item));
  return texts;
}

Items yard() {
  return {takeoff_to(1.2), in_map(2, 4, 1.2), on_earth(47.5, 8.5, 10),
          item_of(MissionItem::Kind::kReturn)};
}

TEST(AddWaypoint, ComesBeforeTheWayHomeUnlessToldOtherwise) {
  Items items = yard();
  EXPECT_EQ(*add_waypoint(items, in_map(5, 5, 1), std::nullopt), 4u);
  EXPECT_THAT(texts(items),
              ElementsAre("takeoff to 1.2 m", "goto 2.00 4.00 1.20 m",
                          "gps 47.5000000 8.5000000 at 10 m", "goto 5.00 5.00 1.00 m", "return"));
  Items open{in_map(1, 1, 1)};
  EXPECT_EQ(*add_waypoint(open, in_map(2, 2, 2), std::nullopt), 2u);
  Items none;
  EXPECT_EQ(*add_waypoint(none, in_map(2, 2, 2), std::nullopt), 1u);
  // A landing that is not the end does not keep others from the end.
  Items hops{item_of(MissionItem::Kind::kLand), in_map(1, 1, 1)};
  EXPECT_EQ(*add_waypoint(hops, in_map(2, 2, 2), std::nullopt), 3u);
}

TEST(AddWaypoint, GoesToAnyPlaceThatThereIs) {
  for (std::size_t at = 1; at <= 5; ++at) {
    Items items = yard();
    ASSERT_EQ(*add_waypoint(items, in_map(9, 9, 9), at), at);
    EXPECT_EQ(items.size(), 5u);
    EXPECT_EQ(item_text(items[at - 1]), "goto 9.00 9.00 9.00 m");
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(at - 1));
    EXPECT_EQ(texts(items), texts(yard())) << "the others keep their order";
  }
  Items items = yard();
  EXPECT_THAT(add_waypoint(items, in_map(1, 1, 1), 0).error().reason, HasSubstr("from 1 to 5"));
  EXPECT_THAT(add_waypoint(items, in_map(1, 1, 1), 6).error().reason, HasSubstr("at 6"));
  EXPECT_THAT(add_waypoint(items, on_earth(91, 0, 1), std::nullopt).error().reason,
              HasSubstr("no place on Earth"));
  MissionItem fast = in_map(1, 1, 1);
  fast.place.speed = 2.0;
  EXPECT_THAT(add_waypoint(items, fast, std::nullopt).error().reason,
              HasSubstr("only a waypoint on Earth"));
  EXPECT_EQ(texts(items), texts(yard())) << "what is refused changes nothing";
}

TEST(MoveWaypoint, KeepsWhatIsNotSaid) {
  Items items = yard();
  items[1].place.yaw = 1.0;
  items[1].hold = 3.0;
  ASSERT_TRUE(move_waypoint(items, 2, in_map(-1, -2, 2)).ok());
  EXPECT_EQ(items[1].place.position, Eigen::Vector3d(-1, -2, 2));
  EXPECT_EQ(items[1].place.yaw, 1.0);
  EXPECT_EQ(items[1].hold, 3.0);
  MissionItem all = in_map(0, 0, 1);
  all.place.yaw = -1.0;
  all.hold = 7.0;
  ASSERT_TRUE(move_waypoint(items, 2, all).ok());
  EXPECT_EQ(items[1].place.yaw, -1.0);
  EXPECT_EQ(items[1].hold, 7.0);
  ASSERT_TRUE(move_waypoint(items, 3, on_earth(1, 2, 3)).ok());
  EXPECT_EQ(items[2].global->longitude, 2.0);
}

TEST(MoveWaypoint, RefusesWhatIsNoWaypointAndTheOtherKind) {
  Items items = yard();
  const auto why = [&items](std::size_t number, const MissionItem& to) {
    const Status moved = move_waypoint(items, number, to);
    return moved.ok() ? "" : moved.error().reason;
  };
  EXPECT_THAT(why(1, in_map(1, 1, 1)), HasSubstr("item 1 is no waypoint but 'takeoff to 1.2 m'"));
  EXPECT_THAT(why(3, in_map(1, 1, 1)), HasSubstr("item 3 is a place on Earth"));
  EXPECT_THAT(why(2, on_earth(1, 1, 1)), HasSubstr("without --gps"));
  EXPECT_THAT(why(5, in_map(1, 1, 1)), HasSubstr("items 1 to 4"));
  EXPECT_THAT(why(0, in_map(1, 1, 1)), HasSubstr("no item 0"));
  EXPECT_THAT(why(2, in_map(1e9, 1, 1)), HasSubstr("not a place"));
  EXPECT_EQ(texts(items), texts(yard()));
}

TEST(RemoveItem, TakesOutThatOneAlone) {
  for (std::size_t number = 1; number <= 4; ++number) {
    Items items = yard();
    ASSERT_TRUE(remove_item(items, number).ok());
    Items wanted = yard();
    wanted.erase(wanted.begin() + static_cast<std::ptrdiff_t>(number - 1));
    EXPECT_EQ(texts(items), texts(wanted));
  }
  Items none;
  EXPECT_THAT(remove_item(none, 1).error().reason, HasSubstr("no items"));
}

TEST(MissionList, TableAndJsonSayTheSame) {
  Items items = yard();
  items[1].place.yaw = kTurn / 4;
  items[1].hold = 2.5;
  items[2].place.speed = 3.0;
  items.push_back(hold_for(4));
  items.push_back(item_of(MissionItem::Kind::kClaw));
  items.push_back(item_of(MissionItem::Kind::kLand));
  EXPECT_EQ(mission_table(items),
            "   1  takeoff to 1.2 m\n"
            "   2  goto 2.00 4.00 1.20 m, yaw 90 deg, hold 2.5 s\n"
            "   3  gps 47.5000000 8.5000000 at 10 m, 3 m/s\n"
            "   4  return\n"
            "   5  hold 4 s\n"
            "   6  claw close\n"
            "   7  land\n");
  const auto json = nlohmann::json::parse(mission_json(items));
  ASSERT_EQ(json.size(), 7u);
  EXPECT_EQ(json[0], (nlohmann::json{{"item", 1}, {"kind", "takeoff"}, {"altitude", 1.2}}));
  EXPECT_EQ(json[1], (nlohmann::json{{"item", 2},
                                     {"kind", "goto"},
                                     {"x", 2.0},
                                     {"y", 4.0},
                                     {"z", 1.2},
                                     {"yaw_deg", 90.0},
                                     {"hold", 2.5}}));
  EXPECT_EQ(json[2]["latitude"], 47.5);
  EXPECT_EQ(json[2]["speed"], 3.0);
  EXPECT_EQ(json[5], (nlohmann::json{{"item", 6}, {"kind", "claw"}, {"open", false}}));
  EXPECT_EQ(mission_json({}), "[]");
}

}  // namespace
}  // namespace swiftlet
