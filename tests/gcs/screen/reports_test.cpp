// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/reports.hpp"

#include <gtest/gtest.h>

#include "gcs/screen/shell/ground_commands.hpp"

namespace swiftlet::screen {
namespace {

namespace code = swiftlet_msgs::msg::ModeCommand_Constants;
namespace claw = swiftlet_msgs::msg::ClawState_Constants;
namespace mission = swiftlet_msgs::msg::MissionState_Constants;

TEST(Reports, AMissionIsWhatTheVehicleSays) {
  swiftlet_msgs::msg::MissionState message;
  message.state(mission::PAUSED);
  message.item(3);
  message.count(5);
  message.reason("manual control");
  const MissionReport report = report_of(message);
  EXPECT_EQ(report.state, MissionReport::State::kPaused);
  EXPECT_EQ(report.item, 3);
  EXPECT_EQ(report.count, 5);
  EXPECT_EQ(report.reason, "manual control");
  message.state(200);
  EXPECT_EQ(report_of(message).state, MissionReport::State::kNone) << "of a later version";
}

TEST(Reports, AClawHasAFaultOnlyWhereItSaysSo) {
  swiftlet_msgs::msg::ClawState message;
  message.reason("was stuck");
  message.state(claw::HOLDING);
  EXPECT_EQ(report_of(message).state, "holding");
  EXPECT_EQ(report_of(message).fault, "");
  message.state(claw::FAULT);
  EXPECT_EQ(report_of(message).fault, "was stuck");
  message.state(200);
  EXPECT_EQ(report_of(message).state, "?");
}

TEST(GroundCommands, AreThoseOfTheVerbs) {
  using Kind = Action::Kind;
  const std::pair<Kind, std::uint8_t> expected[] = {{Kind::kFlyMission, code::MISSION_START},
                                                    {Kind::kGoOn, code::MISSION_START},
                                                    {Kind::kPauseMission, code::MISSION_PAUSE},
                                                    {Kind::kClearMission, code::MISSION_CLEAR},
                                                    {Kind::kOpenClaw, code::CLAW_OPEN},
                                                    {Kind::kCloseClaw, code::CLAW_CLOSE},
                                                    {Kind::kHover, code::HOVER}};
  for (const auto& [kind, command] : expected) {
    EXPECT_EQ(ground_command(action(kind)).command, command);
    EXPECT_FALSE(ground_command(action(kind)).is_mission());
    EXPECT_EQ(ground_command(action(kind)).item, 0u) << "where it was paused";
  }
  Action go_to = action(Kind::kGoTo);
  go_to.place = {1.0, 2.0, 3.0};
  const GroundCommand command = ground_command(go_to);
  ASSERT_TRUE(command.go_to);
  EXPECT_EQ(command.go_to->y, 2.0);
  EXPECT_EQ(command.go_to->z, 3.0);
}

}  // namespace
}  // namespace swiftlet::screen
