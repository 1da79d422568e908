// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/reports.hpp"

#include <gtest/gtest.h>

#include "components/conversions.hpp"
#include "components/telemetry/telemetry_message.hpp"
#include "gcs/screen/shell/ground_commands.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
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

TEST(Reports, TelemetrySaysWhatTheTopicsSayThatItWasMadeOf) {
  swiftlet_msgs::msg::VehicleStatus status;
  status.mode(swiftlet_msgs::msg::VehicleStatus_Constants::GPS_GUIDANCE);
  status.armed(true);
  status.reason("asked for");
  status.height(3.25);
  RigidBodyState state;
  state.p_WB = {1.0, -2.0, 3.0};
  state.v_WB_W = {0.5, 0.25, -0.125};
  state.q_WB = Eigen::Quaterniond(0.8, 0.2, -0.3, 0.4).normalized();
  nav_msgs::msg::Odometry odometry;
  odometry.pose().pose(to_pose(state.p_WB, state.q_WB));
  const Eigen::Vector3d v_B = state.q_WB.inverse() * state.v_WB_W;
  odometry.twist().twist().linear().x(v_B.x());
  odometry.twist().twist().linear().y(v_B.y());
  odometry.twist().twist().linear().z(v_B.z());
  swiftlet_msgs::msg::MissionState flown;
  flown.state(mission::FLYING);
  flown.item(2);
  flown.count(7);
  swiftlet_msgs::msg::ClawState held;
  held.state(claw::HOLDING);
  sensor_msgs::msg::BatteryState battery;
  battery.percentage(0.5F);
  battery.voltage(15.25F);

  VehicleKnowledge known;
  known.status = &status;
  known.odometry = &odometry;
  known.mission = &flown;
  known.claw = &held;
  known.battery = &battery;
  known.time_left = 321.0;
  const TelemetryReport report = report_of(make_telemetry(Time(1s), known));
  ASSERT_TRUE(report.vehicle && report.pose && report.claw);
  const VehicleReport expected = report_of(status);
  EXPECT_EQ(report.vehicle->mode, expected.mode);
  EXPECT_EQ(report.vehicle->in_flight, expected.in_flight);
  EXPECT_EQ(report.vehicle->navigates, expected.navigates);
  EXPECT_TRUE(report.vehicle->armed);
  EXPECT_EQ(report.vehicle->reason, "asked for");
  EXPECT_EQ(report.vehicle->height, 3.25);
  EXPECT_LT((report.pose->p_WB - state.p_WB).norm(), 1e-6);
  EXPECT_LT((report.pose->v_WB_W - state.v_WB_W).norm(), 1e-6);
  EXPECT_LT(report.pose->q_WB.angularDistance(state.q_WB), 1e-5);
  EXPECT_EQ(report.mission.state, MissionReport::State::kFlying);
  EXPECT_EQ(report.mission.item, 2);
  EXPECT_EQ(report.mission.count, 7);
  EXPECT_EQ(report.claw->state, "holding");
  EXPECT_EQ(report.battery_seconds_left, 321.0);
  ASSERT_TRUE(report.battery);
  EXPECT_EQ(report.battery->percentage, 0.5);
  EXPECT_EQ(report.battery->voltage, 15.25);
  EXPECT_FALSE(report.fix) << "nobody said";

  const TelemetryReport nothing = report_of(make_telemetry(Time(1s), {}));
  EXPECT_FALSE(nothing.vehicle || nothing.pose || nothing.battery || nothing.battery_seconds_left ||
               nothing.fix || nothing.claw);
}

TEST(Reports, WhatComesFromTheGroundHasNoShareOfTheLink) {
  diagnostic_msgs::msg::DiagnosticArray array;
  const auto add = [&](const char* name, const char* key, const char* value) {
    diagnostic_msgs::msg::DiagnosticStatus status;
    status.name(name);
    diagnostic_msgs::msg::KeyValue entry;
    entry.key(key);
    entry.value(value);
    status.values().push_back(entry);
    array.status().push_back(status);
  };
  add("ground_link", "bytes_per_s", "900");
  add("ground_link: odometry", "bytes_per_s", "700");
  add("ground_link: mode", "messages_per_s", "3");
  const auto link = link_of(array);
  ASSERT_TRUE(link);
  EXPECT_EQ(link->bytes_per_s, 900.0);
  ASSERT_EQ(link->topics.size(), 1u);
  EXPECT_EQ(link->topics[0].topic, "odometry");
  EXPECT_EQ(link->topics[0].bytes_per_s, 700.0);
}

TEST(Reports, ASerialLinkHasABudgetToo) {
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name("serial_link");
  for (const auto& [key, value] : {std::pair{"bytes_received_per_s", "900"},
                                   {"bytes_sent_per_s", "80"},
                                   {"capacity_bytes_per_s", "1920"}}) {
    diagnostic_msgs::msg::KeyValue entry;
    entry.key(key);
    entry.value(value);
    status.values().push_back(entry);
  }
  diagnostic_msgs::msg::DiagnosticArray array;
  array.status().push_back(status);
  const auto link = link_of(array);
  ASSERT_TRUE(link);
  EXPECT_EQ(link->bytes_per_s, 900.0);
  EXPECT_EQ(link->budget_bytes_per_s, 1920.0);
  ASSERT_EQ(link->topics.size(), 2u);
  EXPECT_EQ(link->topics[1].bytes_per_s, 80.0);
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
