// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "components/commander/mission_message.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Items = MissionInbox::Items;
namespace code = swiftlet_msgs::msg::ModeCommand_Constants;

constexpr Time kNow{100s};

MissionItem random_item(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-9.0, 9.0);
  const auto perhaps = [&random] { return random() % 2 == 0; };
  MissionItem item;
  item.kind = static_cast<MissionItem::Kind>(random() % 6);
  item.place.position = {number(random), number(random), number(random)};
  if (perhaps()) item.place.yaw = number(random);
  if (perhaps()) {
    item.global = GlobalWaypoint{5.0 * number(random), 15.0 * number(random), 9.0};
    if (perhaps()) item.place.speed = 1.0 + std::abs(number(random));
  }
  item.hold = std::abs(number(random));
  item.altitude = std::abs(number(random));
  item.open = perhaps();
  return item;
}

MissionItem in_the_air() {
  MissionItem item;
  item.place.position.z() = 1.2;
  return item;
}

Items random_items(std::mt19937& random, std::size_t count) {
  Items items;
  for (std::size_t i = 0; i < count; ++i) items.push_back(to_msg(random_item(random)));
  return items;
}

std::vector<swiftlet_msgs::msg::MissionPart> all_parts(const std::string& id, const Items& items) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < items.size(); ++i) all.push_back(i);
  return make_parts(kNow, id, items, all);
}

TEST(MissionItemMessage, ThereAndBackIsTheSame) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const auto message = to_msg(random_item(random));
    const auto item = from_msg(message);
    ASSERT_TRUE(item.ok()) << item.error().reason;
    EXPECT_EQ(to_msg(*item), message);
  }
  swiftlet_msgs::msg::MissionItem later;
  later.kind(6);
  EXPECT_EQ(from_msg(later).error().reason, "there is no item of kind 6");
}

TEST(MissionInbox, PutsPartsTogetherInAnyOrder) {
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    const Items items = random_items(random, 1 + random() % 60);
    auto parts = all_parts("a", items);
    std::shuffle(parts.begin(), parts.end(), random);
    MissionInbox inbox;
    for (const auto& part : parts) {
      EXPECT_FALSE(inbox.is_complete());
      ASSERT_TRUE(inbox.add(part).ok());
      ASSERT_TRUE(inbox.add(part).ok()) << "again";
    }
    ASSERT_TRUE(inbox.is_complete());
    EXPECT_TRUE(inbox.missing(1000).empty());
    EXPECT_EQ(*inbox.mission(), items);
  }
}

TEST(MissionInbox, SaysWhatIsMissing) {
  std::mt19937 random(3);
  const Items items = random_items(random, 20);
  MissionInbox inbox;
  for (const auto& part : make_parts(kNow, "a", items, {0, 1, 5, 6, 7, 19})) {
    ASSERT_TRUE(inbox.add(part).ok());
  }
  EXPECT_THAT(inbox.missing(5), testing::ElementsAre(2, 3, 4, 8, 9));
  EXPECT_FALSE(inbox.mission().ok());
}

TEST(MissionInbox, RefusesWhatContradictsItself) {
  std::mt19937 random(4);
  const Items items = random_items(random, 20);
  const auto parts = all_parts("a", items);
  MissionInbox inbox(25);
  ASSERT_TRUE(inbox.add(parts[0]).ok());
  auto wrong = parts[1];
  wrong.first(15);  // and eight from there
  EXPECT_THAT(inbox.add(wrong).error().reason, HasSubstr("contradicts"));
  wrong = parts[1];
  wrong.checksum(1);
  EXPECT_FALSE(inbox.add(wrong).ok());
  wrong = parts[1];
  wrong.first(4294967295U);
  EXPECT_FALSE(inbox.add(wrong).ok());
  wrong.id("b");
  wrong.count(26);
  EXPECT_THAT(inbox.add(wrong).error().reason, HasSubstr("it has 26 items, 1 to 25"));
  wrong.count(0);
  EXPECT_FALSE(inbox.add(wrong).ok());
  wrong.id("");
  EXPECT_FALSE(inbox.add(wrong).ok());
}

struct Desk : testing::Test {
  void upload(const std::string& id, const std::vector<MissionItem>& mission) {
    Items items;
    for (const MissionItem& item : mission) items.push_back(to_msg(item));
    for (const auto& part : all_parts(id, items)) desk.hear(part, director, kNow);
  }
  std::optional<Result<Acceptance>> order(std::uint8_t what) {
    swiftlet_msgs::msg::ModeCommand command;
    command.command(what);
    return desk.carry_out(command, director, {}, kNow);
  }
  FlightDirector director{FlightDirector::Params()};
  MissionDesk desk{MissionRunner::Params()};
};

TEST_F(Desk, ASuccessorHasAllOfIt) {
  MissionItem first, second;
  first.place.position = {1.0, 2.0, 3.0};
  second.kind = MissionItem::Kind::kHold;
  second.hold = 4.0;
  upload("a", {first, second});
  desk.hear(swiftlet_msgs::msg::ClawState(), kNow);
  ASSERT_TRUE((*order(code::CLAW_CLOSE)).ok());
  swiftlet_msgs::msg::CommanderState state;
  desk.write(state);
  for (const bool state_first : {true, false}) {
    MissionDesk successor{MissionRunner::Params()};
    if (state_first) successor.restore(state);
    successor.restore(desk.whole(kNow));
    successor.restore(state);
    EXPECT_FALSE(differs(successor.state(kNow), desk.state(kNow)));
    EXPECT_EQ(successor.whole(kNow).items(), desk.whole(kNow).items());
    EXPECT_EQ(successor.claw_open(), false);
  }
}

TEST_F(Desk, AClawThatIsNotHeardIsNotCommanded) {
  EXPECT_THAT((*order(code::CLAW_OPEN)).error().reason, HasSubstr("no claw is heard"));
  EXPECT_FALSE(desk.claw_open());
  desk.hear(swiftlet_msgs::msg::ClawState(), kNow - 2s);
  EXPECT_FALSE((*order(code::CLAW_OPEN)).ok());
  desk.hear(swiftlet_msgs::msg::ClawState(), kNow);
  EXPECT_TRUE((*order(code::CLAW_OPEN)).ok());
  EXPECT_EQ(desk.claw_open(), true);
}

TEST_F(Desk, OtherCommandsAreNotItsOwn) {
  EXPECT_FALSE(order(code::ARM));
  EXPECT_FALSE(order(code::RETURN));
  EXPECT_THAT((*order(code::MISSION_START)).error().reason, HasSubstr("there is none"));
}

TEST_F(Desk, ClearingForgetsTheMission) {
  upload("a", {in_the_air()});
  EXPECT_EQ(desk.state(kNow).count(), 1U);
  ASSERT_TRUE((*order(code::MISSION_CLEAR)).ok());
  EXPECT_EQ(desk.state(kNow).count(), 0U);
  EXPECT_EQ(desk.state(kNow).id(), "");
  // What was repeated and is late does not bring it back; another upload does.
  upload("a", {in_the_air()});
  EXPECT_EQ(desk.state(kNow).count(), 0U);
  upload("b", {in_the_air()});
  EXPECT_EQ(desk.state(kNow).count(), 1U);
}

TEST_F(Desk, WhoMayNotUploadIsToldWithoutDisturbingWhoMay) {
  std::mt19937 random(6);
  Items items;
  for (int i = 0; i < 20; ++i) items.push_back(to_msg(in_the_air()));
  const auto mine = all_parts("mine", items), others = all_parts("theirs", random_items(random, 3));
  desk.hear(mine[0], director, kNow);
  desk.refuse(others[0], "not you", kNow + 1s);
  EXPECT_FALSE(desk.state(kNow).upload_refused());
  EXPECT_EQ(desk.state(kNow).upload_id(), "mine");
  // Of who gave up midway nothing is waited for.
  desk.refuse(others[0], "not you", kNow + 10s);
  EXPECT_EQ(desk.state(kNow).upload_id(), "theirs");
  EXPECT_EQ(desk.state(kNow).upload_reason(), "not you");
  desk.hear(others[0], director, kNow + 11s);
  EXPECT_EQ(desk.state(kNow).count(), 0U) << "what was refused stays so";
  for (const auto& part : all_parts("again", items)) desk.hear(part, director, kNow + 12s);
  EXPECT_EQ(desk.state(kNow).count(), 20U);
}

TEST_F(Desk, PartsOfAnEarlierUploadThatAreLateDisturbNothing) {
  std::mt19937 random(5);
  const auto earlier = all_parts("a", random_items(random, 20));
  Items items;
  for (int i = 0; i < 20; ++i) items.push_back(to_msg(in_the_air()));
  const auto later = all_parts("b", items);
  desk.hear(earlier[0], director, kNow);
  desk.hear(later[0], director, kNow);
  desk.hear(earlier[1], director, kNow);
  desk.hear(later[1], director, kNow);
  EXPECT_EQ(desk.state(kNow).upload_id(), "b");
  desk.hear(later[2], director, kNow);
  EXPECT_EQ(desk.state(kNow).id(), "b");
  EXPECT_EQ(desk.whole(kNow).items(), items);
}

}  // namespace
}  // namespace swiftlet
