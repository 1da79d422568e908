// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

swiftlet_msgs::msg::CommandAck ack(const std::string& id, const std::string& name,
                                   const std::string& refusal = "") {
  swiftlet_msgs::msg::CommandAck ack;
  ack.id(id);
  ack.name(name);
  ack.accepted(refusal.empty());
  ack.reason(refusal);
  return ack;
}

std::string told(CommandLog& log, const swiftlet_msgs::msg::CommandAck& ack) {
  const auto told = log.hear(ack);
  return told ? told->text : "";
}

TEST(CommandLog, TellsOnceWhatBecameOfEachCommand) {
  CommandLog log;
  EXPECT_EQ(told(log, ack("b", "mission start", "not armed")), "mission start refused: not armed");
  EXPECT_EQ(told(log, ack("a", "arm")), "arm: accepted");
  EXPECT_EQ(told(log, ack("a", "arm")), "") << "answers are repeated";
  EXPECT_EQ(told(log, ack("e", "land", "land refused: on the ground")),
            "land refused: on the ground");
  EXPECT_EQ(told(log, ack("c", "arm", "armed already")), "arm refused: armed already")
      << "another one";
}

TEST(CommandLog, SaysWhoCommanded) {
  CommandLog log;
  auto answer = ack("a", "land", "station 'base' has control, not 'tablet'");
  answer.station("tablet");
  EXPECT_EQ(told(log, answer), "land refused: station 'base' has control, not 'tablet' (tablet)");
  EXPECT_EQ(told(log, ack("goal_pose 12.5 0a", "")), "goal_pose 12.5 0a: accepted")
      << "what has no name has its identity";
}

TEST(CommandLog, RemembersTheLastHundred) {
  CommandLog log;
  for (int i = 0; i < 1000; ++i) told(log, ack(std::to_string(i), "land"));
  EXPECT_EQ(told(log, ack("901", "land")), "");
  EXPECT_EQ(told(log, ack("5", "land")), "land: accepted") << "what is forgotten is told again";
}

}  // namespace
}  // namespace swiftlet
