// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

namespace code = swiftlet_msgs::msg::ModeCommand_Constants;

swiftlet_msgs::msg::ModeCommand command(const std::string& id, std::uint8_t what) {
  swiftlet_msgs::msg::ModeCommand command;
  command.id(id);
  command.command(what);
  return command;
}
swiftlet_msgs::msg::CommandAck ack(const std::string& id, const std::string& refusal = "") {
  swiftlet_msgs::msg::CommandAck ack;
  ack.id(id);
  ack.accepted(refusal.empty());
  ack.reason(refusal);
  return ack;
}
const Time kBegin(std::chrono::seconds(1000));
const Time kLater = kBegin + CommandLog::kPatience;

std::string news(CommandLog& log, Time now) {
  std::string text;
  for (const CommandLog::Told& told : log.news(now)) text += told.text;
  return text;
}
std::string told(CommandLog& log, const swiftlet_msgs::msg::CommandAck& ack) {
  log.hear(ack, kBegin);
  return news(log, kBegin);
}

TEST(CommandLog, TellsOnceWhatBecameOfEachCommand) {
  CommandLog log;
  for (int i = 0; i < 3; ++i) log.hear(command("a", code::ARM));
  log.hear(command("b", code::MISSION_START));
  EXPECT_EQ(told(log, ack("b", "not armed")), "mission start refused: not armed");
  EXPECT_EQ(told(log, ack("a")), "arm: accepted");
  EXPECT_EQ(told(log, ack("a")), "") << "answers are repeated";
  log.hear(command("a", code::ARM));
  EXPECT_EQ(told(log, ack("a")), "");
  log.hear(command("e", code::LAND));
  EXPECT_EQ(told(log, ack("e", "land refused: on the ground")), "land refused: on the ground");
  log.hear(command("c", code::ARM));
  EXPECT_EQ(told(log, ack("c", "armed already")), "arm refused: armed already") << "another one";
}

TEST(CommandLog, AnAnswerWaitsForItsCommand) {
  CommandLog log;
  EXPECT_EQ(told(log, ack("a")), "");
  log.hear(command("a", code::ARM));
  EXPECT_EQ(news(log, kBegin), "arm: accepted");
  EXPECT_EQ(news(log, kLater), "");
}

TEST(CommandLog, PlacesAreCommandsTooAndSoIsWhatOthersSend) {
  CommandLog log;
  swiftlet_msgs::msg::Mission mission;
  mission.id("m");
  mission.waypoints().resize(1);
  log.hear(mission);
  EXPECT_EQ(told(log, ack("m")), "goto: accepted");
  mission.id("n");
  mission.waypoints().resize(4);
  log.hear(mission);
  EXPECT_EQ(told(log, ack("n", "too far")), "4 waypoints refused: too far");
  EXPECT_EQ(told(log, ack("goal_pose 12.5 0a")), "");
  EXPECT_EQ(news(log, kLater), "goal_pose 12.5 0a: accepted");
  EXPECT_EQ(news(log, kLater), "");
}

TEST(CommandLog, RemembersTheLastHundred) {
  CommandLog log;
  for (int i = 0; i < 1000; ++i) log.hear(command(std::to_string(i), code::LAND));
  EXPECT_EQ(told(log, ack("999")), "land: accepted");
  EXPECT_EQ(told(log, ack("901")), "land: accepted");
  log.hear(ack("5"), kBegin);
  EXPECT_EQ(news(log, kLater), "5: accepted") << "what is forgotten has its identity alone";
}

}  // namespace
}  // namespace swiftlet
