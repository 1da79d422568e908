// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/story_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "components/bag/recording_records.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/report/map_picture.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/components/report/made_up_recording.hpp"

namespace swiftlet {
namespace {

namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class StoryTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
  MadeUpRecording made_up_{folder_ / "flight.mcap"};
};

/// On the ground for 2 s, take-off until 4, flown until 8, landed at 10, at rest until 12.
std::uint8_t mode_at(double time) {
  return time < 2.0   ? mode::GROUNDED
         : time < 4.0 ? mode::TAKEOFF
         : time < 8.0 ? mode::INDOOR_NAVIGATION
         : time < 10. ? mode::LAND
                      : mode::GROUNDED;
}

void add_modes(MadeUpRecording& recording) {
  for (int i = 0; i < 120; ++i) {
    const double time = 0.1 * i;
    const std::uint8_t now = mode_at(time);
    recording.add("vehicle/status", time,
                  status_at(time, now, now == mode::TAKEOFF ? "takeoff was asked for" : ""));
  }
}

TEST_F(StoryTest, TellsModesWithTheirReasonsAndTheFlightTime) {
  add_modes(made_up_);
  const FlightStory story = told(made_up_.close());
  ASSERT_EQ(story.modes.size(), 5U);
  EXPECT_EQ(story.modes[2].mode, "Indoor Navigation");
  EXPECT_NEAR(story.modes[2].from, 4.0, 1e-6);
  EXPECT_NEAR(story.modes[2].to, 8.0, 1e-6);
  EXPECT_NEAR(*story.figures.flight_time, 8.0, 1e-6);
  EXPECT_THAT(texts_of(story, "mode"), ElementsAre("Grounded → Takeoff: takeoff was asked for",
                                                   "Takeoff → Indoor Navigation",
                                                   "Indoor Navigation → Land", "Land → Grounded"));
}

TEST_F(StoryTest, ScoresTheFlightAndNotTheGroundNorTheLanding) {
  add_modes(made_up_);
  double squares = 0.0;
  int scored = 0;
  for (int i = 0; i < 1200; ++i) {
    const double time = 0.01 * i;
    const std::uint8_t now = mode_at(time);
    const bool flying = now != mode::GROUNDED && now != mode::LAND;
    const double off = flying ? 0.05 * std::sin(time) : 9.0;
    const Eigen::Vector3d wanted(1.0 + 0.5 * time, 2.0, 1.1);
    made_up_.add("setpoint", time, setpoint_at(time, wanted));
    made_up_.add("odometry", time, odometry_at(time, wanted + Eigen::Vector3d(0, off, 0)));
    // A mode counts from the first status that has it, which is recorded before the odometry of
    // the same moment or behind it; those moments are a few of hundreds.
    if (flying) {
      squares += off * off;
      ++scored;
    }
  }
  const FlightStory story = told(made_up_.close());
  ASSERT_TRUE(story.figures.tracking);
  EXPECT_NEAR(story.figures.tracking->rms.x(), 0.0, 1e-9);
  EXPECT_NEAR(story.figures.tracking->rms.y(), std::sqrt(squares / scored), 5e-4);
  EXPECT_NEAR(*story.figures.largest_height, 1.0, 1e-9);  // the take-off point is 0.1 m high
  EXPECT_FALSE(story.figures.true_tracking);
}

TEST_F(StoryTest, TheGuardsSetpointsCountWhileItFlies) {
  for (int i = 0; i < 400; ++i) {
    const double time = 0.01 * i;
    const bool guard_flies = time >= 1.0 && time < 3.0;
    made_up_.add("odometry", time + 0.001, odometry_at(time + 0.001, {0, 0, 1}));
    if (guard_flies) made_up_.add("guard/setpoint", time, setpoint_at(time, {0, 0, 1}));
    made_up_.add("setpoint", time + 0.0001,
                 setpoint_at(time + 0.0001, {guard_flies ? 50.0 : 0.0, 0, 1}));
  }
  const FlightStory story = told(made_up_.close());
  EXPECT_LT(story.figures.tracking->largest, 1e-6);
}

TEST_F(StoryTest, CommandsGuardDiagnosticsAndComponentsAreEvents) {
  swiftlet_msgs::msg::ModeCommand command;
  command.id("17");
  command.command(swiftlet_msgs::msg::ModeCommand_Constants::TAKEOFF);
  command.altitude(1.25);
  swiftlet_msgs::msg::CommandAck ack;
  ack.id("17");
  ack.reason("the battery is at 12 %");
  for (int again = 0; again < 3; ++again) {  // a command is repeated until it is answered
    made_up_.add("mode", 1.0 + 0.1 * again, command);
    made_up_.add("mode/ack", 1.05 + 0.1 * again, ack);
  }
  swiftlet_msgs::msg::GuardStatus guard;
  for (int i = 0; i < 30; ++i) {
    guard.acting(i >= 10 && i < 20);
    guard.reason(i >= 10 ? "a wall is 0.2 m ahead" : "");
    made_up_.add("guard/status", 2.0 + 0.1 * i, guard);
  }
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name("estimator");
  for (int i = 0; i < 6; ++i) {
    status.level(i == 3 || i == 4 ? 1 : 0);
    status.message(i == 3 || i == 4 ? "no pose used within the last second" : "");
    diagnostic_msgs::msg::DiagnosticArray array;
    array.status({status});
    made_up_.add("diagnostics", 5.0 + i, array);
  }
  swiftlet_msgs::msg::ComponentStatus component;
  component.component_name("planner");
  component.instance("a");
  component.active(true);
  component.blocked(true);
  component.problems({"map: nobody publishes it"});
  made_up_.add("component/status", 6.0, component);
  made_up_.add("component/status", 7.0, component);
  component.problems({});
  made_up_.add("component/status", 8.0, component);
  component.instance("b");
  component.process("second");
  component.term(2);
  made_up_.add("component/status", 9.0, component);

  const FlightStory story = told(made_up_.close());
  EXPECT_THAT(texts_of(story, "command"),
              ElementsAre("takeoff to 1.25 m: asked for",
                          "takeoff to 1.25 m: refused: the battery is at 12 %"));
  EXPECT_THAT(texts_of(story, "guard"),
              ElementsAre("flies instead of the commander: a wall is 0.2 m ahead",
                          "gives back to the commander"));
  EXPECT_THAT(texts_of(story, "diagnostics"),
              ElementsAre("estimator: WARN, no pose used within the last second", "estimator: OK"));
  EXPECT_THAT(texts_of(story, "component"),
              ElementsAre("planner: map: nobody publishes it; it cannot do its work",
                          "planner: is well again",
                          "planner: the instance in process second took over (term 2)"));
  for (const FlightEvent& event : story.events.sorted()) {
    if (event.text.find("refused") != std::string::npos) {
      EXPECT_EQ(event.level, FlightEvent::Level::kWarning);
    }
    if (event.text.find("cannot do its work") != std::string::npos) {
      EXPECT_EQ(event.level, FlightEvent::Level::kError);
    }
  }
}

TEST_F(StoryTest, GapsAndLossesComeFromTheRecordingAndItsLedger) {
  for (int i = 0; i < 200; ++i) {
    if (i < 100 || i >= 120) made_up_.add("scan", 0.1 * i, sensor_msgs::msg::LaserScan());
  }
  made_up_.add(to_metadata({{"scan", Loss{17, 3}}}, 0));
  const FlightStory story = told(made_up_.close());
  ASSERT_EQ(story.topics.size(), 1U);
  EXPECT_NEAR(story.topics[0].largest_gap, 2.1, 1e-6);
  EXPECT_EQ(story.topics[0].loss, (Loss{17, 3}));
  EXPECT_TRUE(story.recording.has_ledger);
  EXPECT_THAT(texts_of(story, "sensor"), ElementsAre(HasSubstr("was silent for 2.10 s")));
}

TEST_F(StoryTest, TruthCountsContactsAndJudgesTheEstimate) {
  for (int i = 0; i < 300; ++i) {
    const double time = 0.01 * i;
    swiftlet_msgs::msg::SimTruth truth;
    truth.header(make_header(at(time), "map"));
    truth.pose(to_pose({time, 0, 1}, Eigen::Quaterniond::Identity()));
    truth.contacts(i < 200 ? 0 : 1);
    truth.last_contact(i < 200 ? "" : "table");
    truth.minimum_clearance(0.25);
    made_up_.add("sim/truth", time, truth);
    made_up_.add("odometry", time, odometry_at(time, {time + 0.03, 0.04, 1}));
  }
  const FlightStory story = told(made_up_.close());
  EXPECT_EQ(story.figures.contacts, 1U);
  EXPECT_DOUBLE_EQ(*story.figures.least_clearance, 0.25);
  ASSERT_EQ(story.map.contacts.size(), 1U);
  EXPECT_NEAR(story.map.contacts[0].position.x(), 2.0, 1e-9);
  EXPECT_NEAR(story.figures.estimation->rms.norm(), 0.05, 1e-6);
  EXPECT_NEAR(*story.figures.distance, 2.99, 2 * Track::kStep);
}

TEST_F(StoryTest, BatteryIsIntegratedAndNotANumberIsNotKnown) {
  for (int i = 0; i <= 360; ++i) {
    sensor_msgs::msg::BatteryState battery;
    battery.voltage(10.0F);
    battery.current(-4.0F);  // some drivers say so of a battery that is emptied
    battery.percentage(i == 0 ? NAN : 0.9F - 0.001F * static_cast<float>(i));
    made_up_.add("battery", i, battery);
  }
  const FlightStory story = told(made_up_.close());
  EXPECT_NEAR(story.figures.battery->energy, 4.0, 1e-3);  // 40 W for 0.1 h
  EXPECT_NEAR(*story.figures.battery->first_percentage, 89.9, 1e-3);
  EXPECT_NEAR(*story.figures.battery->last_percentage, 54.0, 1e-3);
}

TEST_F(StoryTest, HeaderTimesOfAnotherClockAreNotBelieved) {
  for (int i = 0; i < 100; ++i) {
    made_up_.add("odometry", 0.01 * i, odometry_at(0.01 * i + 1e6, {0, 0, 1}));
  }
  const auto points = told(made_up_.close()).curves.estimate[0].points();
  ASSERT_EQ(points.size(), 100U);
  EXPECT_NEAR(points.back().time, 0.99, 1e-6);
}

TEST_F(StoryTest, TopicOfAnotherTypeIsLeftOutAndSaid) {
  made_up_.add("odometry", 0.0, sensor_msgs::msg::Range());
  made_up_.add("battery", 1.0, sensor_msgs::msg::BatteryState());
  const FlightStory story = told(made_up_.close());
  EXPECT_FALSE(story.has("odometry"));
  EXPECT_TRUE(story.has("battery"));
  EXPECT_THAT(story.recording.remarks,
              ElementsAre(HasSubstr("odometry: 1 of 1 messages cannot be read")));
}

TEST_F(StoryTest, RecordingThatWasCutOffIsToldAsFarAsItGoes) {
  for (int i = 0; i < 300; ++i) {
    made_up_.add("odometry", 0.01 * i, odometry_at(0.01 * i, {0.01 * i, 0, 1}));
  }
  const FlightStory story = told(made_up_.leave_open());
  EXPECT_FALSE(story.recording.finished);
  EXPECT_FALSE(story.recording.remarks.empty());
  EXPECT_GT(story.curves.speed.samples(), 0U);
}

TEST_F(StoryTest, EmptyRecordingIsAnErrorThatNamesIt) {
  const auto story = read_story(made_up_.close());
  ASSERT_FALSE(story.ok());
  EXPECT_THAT(story.error().reason, HasSubstr("flight.mcap: holds no message"));
}

TEST_F(StoryTest, OneVehicleIsFoundAndOfSeveralOneIsChosen) {
  made_up_.add("uav1/odometry", 0.0, odometry_at(0.0, {0, 0, 1}));
  made_up_.add("/uav2/gps/fix", 0.0, sensor_msgs::msg::NavSatFix());
  const Recording recording = made_up_.close();
  const auto unclear = read_story(recording);
  ASSERT_FALSE(unclear.ok());
  EXPECT_THAT(unclear.error().reason, HasSubstr("--vehicle: uav1, uav2"));
  EXPECT_TRUE(told(recording, "uav1").has("odometry"));
  EXPECT_TRUE(told(recording, "uav2").has("gps/fix"));
  const auto wrong = read_story(recording, "uav3");
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().reason, HasSubstr("no topics of vehicle 'uav3'"));
}

TEST_F(StoryTest, RecordersOfRosPutASlashInFront) {
  made_up_.add("/odometry", 0.0, odometry_at(0.0, {0, 0, 1}));
  EXPECT_TRUE(told(made_up_.close()).has("odometry"));
}

TEST_F(StoryTest, TheLastMapIsDrawnWhereItIsKnown) {
  OccupancyGrid::Params params;
  params.resolution = 0.1;
  OccupancyGrid grid(params, {-5.0, -3.0}, 200, 100);
  made_up_.add("map", 0.0, to_msg(grid, at(0.0)));
  for (int x = 30; x < 60; ++x) grid.set_state({x, 40}, CellState::kFree);
  grid.set_state({59, 49}, CellState::kOccupied);
  made_up_.add("map", 1.0, to_msg(grid, at(1.0)));
  const FlightStory story = told(made_up_.close());
  ASSERT_TRUE(story.map.grid);
  const auto picture = draw_map(*story.map.grid);
  ASSERT_TRUE(picture.ok() && *picture);
  EXPECT_TRUE((*picture)->lower.isApprox(Eigen::Vector2d(-2.0, 1.0), 1e-9));
  EXPECT_TRUE((*picture)->upper.isApprox(Eigen::Vector2d(1.0, 2.0), 1e-9));
  const auto coarse = draw_map(*story.map.grid, 10);
  ASSERT_TRUE(coarse.ok() && *coarse);
  EXPECT_EQ((*coarse)->cells_per_pixel, 3);
  EXPECT_TRUE((*coarse)->lower.isApprox((*picture)->lower, 1e-9));
}

}  // namespace
}  // namespace swiftlet
