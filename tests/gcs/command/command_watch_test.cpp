// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/command_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

using ::testing::HasSubstr;
namespace code = swiftlet_msgs::msg::ModeCommand_Constants;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;
namespace mission = swiftlet_msgs::msg::MissionState_Constants;
namespace claw = swiftlet_msgs::msg::ClawState_Constants;

const std::string kId = "this command";

GroundCommand of(std::uint8_t what) {
  GroundCommand command;
  command.name = "it";
  command.command = what;
  return command;
}
GroundCommand go_to() {
  GroundCommand command;
  command.name = "goto";
  command.go_to = GroundCommand::Place{1.0, 2.0, 3.0};
  return command;
}
swiftlet_msgs::msg::VehicleStatus in(std::uint8_t where, bool mission_done = false,
                                     const std::string& reason = "a reason") {
  swiftlet_msgs::msg::VehicleStatus status;
  status.mode(where);
  status.mission_id(kId);
  status.mission_done(mission_done);
  status.reason(reason);
  status.armed(where != mode::GROUNDED);
  return status;
}

/// "done", "failed" or "goes on".
template <class Message>
std::string after(const GroundCommand& command, const Message& message) {
  const auto outcome = CommandWatch(command, kId).hear(message);
  if (!outcome) return "goes on";
  EXPECT_THAT(outcome->text, HasSubstr(command.name + ": "));
  return outcome->accepted ? "done" : "failed";
}

TEST(CommandWatch, ATakeoffIsDoneInHoverAndFailsOtherwise) {
  EXPECT_EQ(after(of(code::TAKEOFF), in(mode::TAKEOFF)), "goes on");
  EXPECT_EQ(after(of(code::TAKEOFF), in(mode::HOVER)), "done");
  EXPECT_EQ(after(of(code::TAKEOFF), in(mode::LAND)), "failed");
  EXPECT_EQ(after(of(code::TAKEOFF), in(mode::GROUNDED)), "failed");
}

TEST(CommandWatch, AFlightToAPlaceIsDoneWhenItIsThere) {
  EXPECT_EQ(after(go_to(), in(mode::INDOOR_NAVIGATION)), "goes on");
  EXPECT_EQ(after(go_to(), in(mode::HOVER, true)), "done");
  EXPECT_EQ(after(go_to(), in(mode::HOVER, false)), "failed");
  EXPECT_EQ(after(go_to(), in(mode::MANUAL)), "failed");
  EXPECT_EQ(after(go_to(), in(mode::GPS_GUIDANCE)), "failed") << "somebody flies elsewhere";
  const auto outcome =
      CommandWatch(go_to(), kId).hear(in(mode::HOVER, false, "no path to waypoint 1"));
  EXPECT_EQ(outcome->text, "goto: Hover: no path to waypoint 1");
  GroundCommand gps;
  gps.name = "gps";
  gps.go_to_global = GlobalWaypoint{};
  EXPECT_EQ(after(gps, in(mode::GPS_GUIDANCE)), "goes on");
  EXPECT_EQ(after(gps, in(mode::HOVER, true)), "done");
  EXPECT_EQ(after(of(code::EXPLORE), in(mode::INDOOR_EXPLORATION)), "goes on");
  EXPECT_EQ(after(of(code::EXPLORE), in(mode::HOVER, true)), "done");
  EXPECT_EQ(after(of(code::EXPLORE), in(mode::HOVER)), "failed");
}

TEST(CommandWatch, AFlightThatAnotherTookThePlaceOfHasFailed) {
  auto status = in(mode::INDOOR_NAVIGATION);
  status.mission_id("of another ground station");
  const auto outcome = CommandWatch(go_to(), kId).hear(status);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_FALSE(outcome->accepted);
  EXPECT_THAT(outcome->text, HasSubstr("sent elsewhere"));
  auto there = in(mode::HOVER, true);
  there.mission_id("of another ground station");
  EXPECT_EQ(after(go_to(), there), "failed") << "it is there, but where?";
}

TEST(CommandWatch, ALandingIsDoneOnTheGround) {
  EXPECT_EQ(after(of(code::LAND), in(mode::LAND)), "goes on");
  EXPECT_EQ(after(of(code::LAND), in(mode::GROUNDED)), "done");
  EXPECT_EQ(after(of(code::LAND), in(mode::HOVER)), "failed");
  for (const auto way : {mode::INDOOR_NAVIGATION, mode::GPS_GUIDANCE, mode::LAND}) {
    EXPECT_EQ(after(of(code::RETURN), in(way)), "goes on");
  }
  EXPECT_EQ(after(of(code::RETURN), in(mode::GROUNDED)), "done");
  EXPECT_EQ(after(of(code::RETURN), in(mode::HOVER)), "failed");
}

TEST(CommandWatch, ArmingAndModesOfThePilotAreThereAtOnce) {
  EXPECT_EQ(after(of(code::ARM), in(mode::GROUNDED)), "goes on");
  EXPECT_EQ(after(of(code::ARM), in(mode::HOVER)), "done");
  EXPECT_EQ(after(of(code::DISARM), in(mode::GROUNDED)), "done");
  EXPECT_EQ(after(of(code::HOVER), in(mode::HOVER)), "done");
  EXPECT_EQ(after(of(code::MANUAL), in(mode::MANUAL)), "done");
  EXPECT_EQ(after(of(code::ASSIST), in(mode::ASSISTED_MANUAL)), "done");
}

TEST(CommandWatch, AMissionIsDoneWithItsLastItem) {
  swiftlet_msgs::msg::MissionState state;
  state.state(mission::FLYING);
  EXPECT_EQ(after(of(code::MISSION_START), state), "goes on");
  state.state(mission::DONE);
  EXPECT_EQ(after(of(code::MISSION_START), state), "done");
  state.state(mission::PAUSED);
  state.item(3);
  state.count(5);
  state.reason("hover requested");
  EXPECT_EQ(after(of(code::MISSION_START), state), "failed");
  EXPECT_EQ(CommandWatch(of(code::MISSION_START), kId).hear(state)->text,
            "it: paused at item 3 of 5: hover requested");
  state.state(mission::NONE);
  EXPECT_EQ(after(of(code::MISSION_START), state), "failed");
  EXPECT_EQ(after(of(code::MISSION_PAUSE), state), "done");
}

TEST(CommandWatch, AClawIsDoneWhenItIsAsItShallBe) {
  swiftlet_msgs::msg::ClawState state;
  const auto with = [&state](std::uint8_t what) {
    state.state(what);
    return state;
  };
  EXPECT_EQ(after(of(code::CLAW_OPEN), with(claw::OPENING)), "goes on");
  EXPECT_EQ(after(of(code::CLAW_OPEN), with(claw::CLOSED)), "goes on") << "it was so before";
  EXPECT_EQ(after(of(code::CLAW_OPEN), with(claw::OPEN)), "done");
  EXPECT_EQ(after(of(code::CLAW_OPEN), with(claw::FAULT)), "failed");
  EXPECT_EQ(after(of(code::CLAW_CLOSE), with(claw::OPEN)), "goes on");
  EXPECT_EQ(after(of(code::CLAW_CLOSE), with(claw::CLOSED)), "done");
  EXPECT_EQ(after(of(code::CLAW_CLOSE), with(claw::HOLDING)), "done");
}

}  // namespace
}  // namespace swiftlet
