// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/panels.hpp"
#include "gcs/screen/screen_painter.hpp"
#include "gcs/screen/state/circumstances.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const Time kBegin(1000s);

VehicleReport report(const std::string& mode, const std::string& reason = "") {
  VehicleReport report;
  report.mode = mode;
  report.reason = reason;
  report.ready = true;
  report.in_flight = mode != "Grounded";
  return report;
}

RigidBodyState at(double x, double y) {
  RigidBodyState state;
  state.p_WB = {x, y, 1.0};
  return state;
}

std::vector<std::string> texts(const GroundStationModel& model) {
  std::vector<std::string> texts;
  for (const Event& event : model.log().events()) texts.push_back(event.text);
  return texts;
}

std::string screen_of(const GroundStationModel& model, Time now, int width = 80, int height = 24) {
  Surface surface(width, height);
  Controller controller;
  MapPicture picture;
  paint(surface, model, controller, picture, now);
  return to_text(surface);
}

TEST(GroundStationModel, IsStaleAfterASecondAndSaysSo) {
  GroundStationModel model;
  model.hear(report("Hover"), kBegin);
  model.hear(at(1.0, 2.0), kBegin);
  model.tick(kBegin + 1s);
  EXPECT_TRUE(model.vehicle().fresh(kBegin + 1s));
  EXPECT_THAT(screen_of(model, kBegin + 1s), Not(HasSubstr("LOST")));
  const Time late = kBegin + 1s + 1ms;
  model.tick(late);
  EXPECT_FALSE(model.vehicle().fresh(late));
  EXPECT_THAT(texts(model), Contains(HasSubstr("link lost")));
  const std::string screen = screen_of(model, late);
  EXPECT_THAT(screen, HasSubstr("LINK LOST 1.0 s"));
  EXPECT_THAT(screen, HasSubstr("stale: 1.0 s"));
  model.hear(report("Hover"), kBegin + 13s);
  EXPECT_THAT(texts(model).back(), HasSubstr("back after 13.0 s"));
  EXPECT_TRUE(model.vehicle().fresh(kBegin + 13s));
}

TEST(GroundStationModel, NotesEachChangeOfModeWithItsReason) {
  GroundStationModel model;
  model.hear(report("Grounded"), kBegin);
  model.hear(report("Takeoff", "asked for"), kBegin + 1s);
  model.hear(report("Takeoff", "asked for"), kBegin + 2s);
  model.hear(report("Hover", "at its height"), kBegin + 3s);
  EXPECT_THAT(texts(model),
              testing::ElementsAre("vehicle heard: Grounded", "Grounded → Takeoff: asked for",
                                   "Takeoff → Hover: at its height"));
}

TEST(GroundStationModel, NotesWhatBecomesOfTheMission) {
  using State = MissionReport::State;
  GroundStationModel model;
  MissionReport mission;
  const auto hear = [&model, &mission] { model.hear(mission, kBegin); };
  hear();
  mission = {State::kReady, 0, 5, "", "a", "", "a"};
  hear();
  mission.state = State::kFlying;
  mission.item = 1;
  hear();
  hear();
  mission.item = 3;
  hear();
  mission.state = State::kPaused;
  mission.reason = "the pilot took over";
  hear();
  mission.upload = "b";
  mission.refusal = "mission refused: it is being flown";
  hear();
  hear();
  mission.upload = "c";  // again, for the same reason
  hear();
  mission = {State::kDone, 0, 5, "", "a", mission.refusal, "c"};
  hear();
  mission = {State::kNone, 0, 0, "", "", mission.refusal, "c"};
  hear();
  EXPECT_THAT(
      texts(model),
      testing::ElementsAre("mission of 5 items uploaded", "mission: flies from item 1 of 5",
                           "mission: item 3 of 5", "mission paused at item 3: the pilot took over",
                           "mission refused: it is being flown", "mission: all 5 items done",
                           "mission cleared"));
  EXPECT_EQ(model.log().events()[4].times, 2);
}

TEST(GroundStationModel, TrailAndLogAreBounded) {
  GroundStationModel model;
  for (int i = 0; i < 20'000; ++i) {
    model.hear(at(0.05 * i, 0.0), kBegin + i * 10ms);
    model.note(kBegin, Severity::kNote, std::to_string(i));
  }
  EXPECT_EQ(model.trail().size(), GroundStationModel::kLongestTrail);
  EXPECT_NEAR(model.trail().back().x(), 0.05 * 20'000, 0.2) << "the newest are kept";
  EXPECT_EQ(model.log().events().size(), EventLog::kCapacity);
  for (int i = 0; i < 1000; ++i) model.hear(at(7.0, 7.0), kBegin);
  EXPECT_NEAR(model.trail()[model.trail().size() - 2].x(), 0.05 * 20'000, 0.2) << "standing still";
}

TEST(GroundStationModel, TheSameAgainIsCounted) {
  GroundStationModel model;
  for (int i = 0; i < 5; ++i) model.note(kBegin, Severity::kCaution, "x");
  ASSERT_EQ(model.log().events().size(), 1u);
  EXPECT_EQ(model.log().events().front().times, 5);
}

TEST(GroundStationModel, WhatComesAndGoesIsOneEventWithTheNewestNumbers) {
  GroundStationModel model;
  for (int i = 0; i < 30; ++i) {
    const Time now = kBegin + i * 100ms;
    model.note(now, Severity::kCaution, "settles for " + std::to_string(30 - i) + " s");
    model.note(now, Severity::kSuccess, "ready");
  }
  EXPECT_THAT(texts(model), testing::ElementsAre("settles for 1 s", "ready"));
  EXPECT_EQ(model.log().events().front().times, 30);
  model.note(kBegin + 60s, Severity::kSuccess, "ready");
  EXPECT_EQ(model.log().events().size(), 3u) << "long after, it is another one";
}

TEST(GroundStationModel, NamesTheComponentThatFellSilent) {
  GroundStationModel model;
  for (int i = 0; i <= 30; ++i) {
    const Time now = kBegin + i * 100ms;
    model.hear(report("Hover"), now);
    if (i < 10) model.hear_component("planner", {}, now);
    model.hear_component("estimator", {}, now);
    model.tick(now);
  }
  EXPECT_THAT(texts(model), Contains(HasSubstr("planner: silent")));
  EXPECT_THAT(model.problems(kBegin + 3s), Contains(HasSubstr("planner: silent")));
  EXPECT_THAT(model.problems(kBegin + 3s), Not(Contains(HasSubstr("estimator"))));
}

TEST(GroundStationModel, ALostLinkBlamesNoComponent) {
  GroundStationModel model;
  model.hear(report("Hover"), kBegin);
  model.hear_component("planner", {}, kBegin);
  model.tick(kBegin + 5s);
  EXPECT_THAT(texts(model), Not(Contains(HasSubstr("planner"))));
}

TEST(GroundStationModel, SaysWhenTheBatteryFallsBelowAThreshold) {
  GroundStationModel model;
  for (int i = 0; i <= 100; ++i) {
    model.hear(BatteryReport{1.0 - 0.01 * i, 15.0, 10.0, 1.0}, kBegin + i * 1s);
  }
  EXPECT_THAT(texts(model), testing::ElementsAre("battery below 30 %", "battery below 20 %",
                                                 "battery below 10 %"));
}

MissionReport mission(MissionReport::State state, int item, const std::string& reason = "") {
  return {state, item, 5, reason};
}

TEST(GroundStationModel, TellsHowTheVehiclesMissionGoes) {
  using State = MissionReport::State;
  GroundStationModel model;
  VehicleReport vehicle = report("Indoor Navigation");
  vehicle.navigates = true;
  model.hear(vehicle, kBegin);
  EXPECT_THAT(screen_of(model, kBegin), HasSubstr("mission  none"));
  model.hear(mission(State::kReady, 0), kBegin);
  model.hear(mission(State::kFlying, 1), kBegin + 1s);
  EXPECT_TRUE(model.mission_flies());
  model.hear(mission(State::kFlying, 3), kBegin + 2s);
  model.hear(vehicle, kBegin + 2s);
  EXPECT_THAT(screen_of(model, kBegin + 2s), HasSubstr("mission  3 of 5 flying"));
  model.hear(mission(State::kPaused, 3, "manual control"), kBegin + 3s);
  vehicle = report("Manual");
  model.hear(vehicle, kBegin + 3s);
  EXPECT_FALSE(model.mission_flies());
  const std::string paused = screen_of(model, kBegin + 3s, 120, 40);
  EXPECT_THAT(paused, HasSubstr("mission  3 of 5 paused"));
  EXPECT_THAT(paused, HasSubstr("mission paused at item 3: manual"));
  model.hear(mission(State::kDone, 0), kBegin + 4s);
  EXPECT_THAT(texts(model),
              testing::IsSupersetOf({"the vehicle has a mission of 5 items",
                                     "mission: flies from item 1 of 5", "mission: item 3 of 5",
                                     "mission paused at item 3: manual control",
                                     "mission: all 5 items done"}));
}

TEST(GroundStationModel, AWayWithinAMissionIsNotTheMission) {
  GroundStationModel model;
  VehicleReport vehicle = report("Indoor Navigation");
  vehicle.navigates = true;
  vehicle.waypoint_count = 2;
  vehicle.waypoint = 1;
  model.hear(mission(MissionReport::State::kFlying, 2), kBegin);
  model.hear(vehicle, kBegin);
  vehicle.waypoint = 2;
  vehicle.mission_done = true;
  model.hear(vehicle, kBegin + 500ms);
  EXPECT_THAT(texts(model), Not(Contains("mission done")));
  // A goto beside a mission that waits.
  model.hear(mission(MissionReport::State::kPaused, 2), kBegin + 600ms);
  vehicle.mission_done = false;
  vehicle.waypoint = vehicle.waypoint_count = 1;
  model.hear(vehicle, kBegin + 3s);
  EXPECT_THAT(screen_of(model, kBegin + 3s), HasSubstr("mission  to 1 of 1"));
  vehicle.mission_done = true;
  model.hear(vehicle, kBegin + 4s);
  EXPECT_THAT(texts(model), Contains("mission done"));
}

TEST(GroundStationModel, AClawIsShownOnceItWasHeard) {
  GroundStationModel model;
  model.hear(report("Hover"), kBegin);
  EXPECT_THAT(screen_of(model, kBegin), Not(HasSubstr("claw")));
  for (const auto& [width, height] : {std::pair(60, 20), std::pair(80, 24), std::pair(120, 40)}) {
    model.hear(ClawReport{"holding", ""}, kBegin);
    EXPECT_THAT(screen_of(model, kBegin, width, height), HasSubstr("claw     holding"));
  }
  model.hear(ClawReport{"fault", "the servo is silent"}, kBegin);
  EXPECT_THAT(texts(model).back(), HasSubstr("claw: the servo is silent"));
  EXPECT_THAT(model.problems(kBegin), Contains(HasSubstr("servo is silent")));
}

TEST(GroundStationModel, LearnsWhereTheMapIsOnEarth) {
  const LocalOrigin truth({47.4, 8.5, 450.0});
  GroundStationModel model;
  EXPECT_FALSE(model.origin());
  for (int i = 0; i < 20; ++i) {
    const Time now = kBegin + i * 200ms;
    const RigidBodyState state = at(0.5 * i, 2.0);
    model.hear(state, now);
    model.hear(std::optional(GlobalFix{truth.to_global(state.p_WB), 1.0}), now);
  }
  ASSERT_TRUE(model.origin());
  EXPECT_LT(model.origin()->to_map(truth.position()).norm(), 0.01);
  // Where the vehicle is not known, a fix says nothing of the map.
  const auto before = model.origin()->position();
  model.hear(std::optional(GlobalFix{{48.0, 8.5, 450.0}, 0.01}), kBegin + 60s);
  EXPECT_EQ(model.origin()->position().latitude, before.latitude);
}

TEST(Circumstances, AreWhatAMissionIsCheckedBy) {
  GroundStationModel model;
  EXPECT_FALSE(circumstances_of(model, kBegin).check.on_ground) << "nobody knows";
  model.hear(report("Grounded"), kBegin);
  model.hear(at(3.0, 4.0), kBegin);
  EXPECT_TRUE(circumstances_of(model, kBegin).check.on_ground);
  EXPECT_EQ(circumstances_of(model, kBegin).check.takeoff.x(), 3.0) << "where it stands";
  VehicleReport flying = report("Hover");
  flying.takeoff_point = Eigen::Vector3d(1.0, 2.0, 0.5);
  model.hear(flying, kBegin);
  EXPECT_FALSE(circumstances_of(model, kBegin).check.on_ground);
  EXPECT_EQ(circumstances_of(model, kBegin).check.takeoff, Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(circumstances_of(model, kBegin).check.start->x(), 3.0) << "where it is";
}

TEST(Circumstances, HaveTheLimitsThatTheVehicleTellsOf) {
  GroundStationModel model;
  const MissionCheckParams before = circumstances_of(model, kBegin).check;
  EXPECT_FALSE(before.flown_speed || before.endurance) << "not known, not checked";
  model.hear(LimitsReport{{20.0, 5.0}, 10.0, 2.0, 0.5, 0.3, 0.4, 0.25, 600.0, 50}, kBegin);
  model.hear(BatteryReport{0.8, 15.0, 1.0, 2.0}, kBegin);
  EXPECT_EQ(circumstances_of(model, kBegin).check.fence.radius, 0.0) << "around what?";
  EXPECT_THAT(circumstances_of(model, kBegin).unknown,
              testing::ElementsAre("where it takes off", "the fence", "obstacles"));
  model.hear(at(3.0, 4.0), kBegin);
  const MissionCheckParams check = circumstances_of(model, kBegin).check;
  EXPECT_EQ(check.fence.radius, 20.0);
  EXPECT_EQ(check.fence.height, 5.0);
  EXPECT_EQ(check.gps_altitude, 10.0);
  EXPECT_EQ(check.gps_speed, 2.0);
  EXPECT_EQ(check.flown_speed, 2.0);
  EXPECT_EQ(check.climb_speed, 0.5);
  EXPECT_EQ(check.descent_speed, 0.3);
  EXPECT_EQ(check.clearance, 0.4);
  EXPECT_EQ(check.reserve, 0.25);
  EXPECT_EQ(check.endurance, 600.0);
  EXPECT_EQ(check.charge, 0.8);
  EXPECT_EQ(check.most_items, 50u);
  model.hear(BatteryReport{NAN, 15.0, 1.0, 2.0}, kBegin);
  EXPECT_FALSE(circumstances_of(model, kBegin).check.endurance) << "of how much?";
  model.hear(BatteryReport{0.8, 15.0, 1.0, 2.0}, kBegin);
  model.hear(LimitsReport{}, kBegin);
  EXPECT_EQ(circumstances_of(model, kBegin).check.gps_speed, before.gps_speed) << "not told";
  EXPECT_FALSE(circumstances_of(model, kBegin).check.endurance);
}

TelemetryReport telemetry(const std::string& mode, double x) {
  TelemetryReport telemetry;
  telemetry.vehicle = report(mode);
  telemetry.vehicle->armed = true;
  telemetry.pose = at(x, 2.0);
  telemetry.battery = BatteryReport{0.62, 15.1, std::nan(""), std::nan("")};
  telemetry.battery_seconds_left = 540.0;
  telemetry.health = TelemetryReport::Health::kWell;
  telemetry.mission = mission(MissionReport::State::kFlying, 2);
  return telemetry;
}

TEST(Telemetry, IsEnoughWhereNothingElseIsHeard) {
  GroundStationModel model;
  Time now = kBegin;
  for (int i = 0; i < 10; ++i) {
    now = kBegin + i * 200ms;
    model.hear(telemetry("Hover", 3.5), now);
    model.tick(now);
  }
  const std::string screen = screen_of(model, now, 120, 40);
  for (const char* text : {"Hover", "ARMED", "by telemetry", "3.50 2.00", "62 %", "15.1 V",
                           "9 min left", "all well", "2 of 5 flying", "known by telemetry alone"}) {
    EXPECT_THAT(screen, HasSubstr(text));
  }
  EXPECT_THAT(screen, Not(HasSubstr("nan")));
  TelemetryReport bad = telemetry("Hover", 3.5);
  bad.health = TelemetryReport::Health::kError;
  model.hear(bad, now);
  EXPECT_THAT(screen_of(model, now), HasSubstr("on board: an error"));
  model.tick(now + 1001ms);
  const std::string late = screen_of(model, now + 1001ms);
  EXPECT_THAT(late, HasSubstr("LINK LOST"));
  EXPECT_THAT(late, HasSubstr("stale: 1.0 s"));
}

TEST(Telemetry, GivesWayToWhatIsHeardFirstHandAndStepsInWithoutAGap) {
  GroundStationModel model;
  for (int i = 0; i <= 30; ++i) {
    const Time now = kBegin + i * 100ms;
    const bool first_hand = i < 10 || i > 25;
    if (first_hand) {
      model.hear(report("Hover"), now);
      model.hear(at(1.0, 2.0), now);
    }
    if (i % 2 == 1) model.hear(telemetry("Land", 9.0), now);
    model.tick(now);
    EXPECT_TRUE(model.vehicle().fresh(now) && model.pose().fresh(now)) << i;
    if (first_hand) {
      EXPECT_EQ(model.vehicle()->mode, "Hover") << i;
      EXPECT_EQ(model.pose()->p_WB.x(), 1.0) << i;
    }
    if (i == 20) {
      EXPECT_EQ(model.vehicle()->mode, "Land");
      EXPECT_EQ(model.pose()->p_WB.x(), 9.0);
    }
  }
  EXPECT_THAT(texts(model), Not(Contains(HasSubstr("link lost"))));
}

TEST(Telemetry, WhatIsNotKnownOnBoardIsNotKnownHere) {
  GroundStationModel model;
  model.hear(TelemetryReport{}, kBegin);
  EXPECT_FALSE(model.vehicle().known() || model.pose().known() || model.battery().known() ||
               model.claw().known());
  // One that flew a mission, and has no item any more, has done it.
  model.hear(telemetry("Hover", 1.0), kBegin);
  TelemetryReport after = telemetry("Hover", 1.0);
  after.mission = mission(MissionReport::State::kReady, 0);
  model.hear(after, kBegin + 200ms);
  EXPECT_EQ(model.mission()->state, MissionReport::State::kDone);
}

TEST(Link, HasARowForEachShareOrOneForThoseThatHaveNoRoom) {
  GroundStationModel model;
  LinkReport link{3000.0, 20'000.0, {}};
  for (int i = 0; i < 12; ++i) link.topics.push_back({"topic" + std::to_string(i), 250.0, false});
  model.hear(link, kBegin);
  const auto painted = [&](int height) {
    Surface surface(34, height);
    paint_link(Pane(surface), model, kBegin);
    return to_text(surface);
  };
  EXPECT_THAT(painted(14), HasSubstr("3.0 kB of 20.0 kB/s"));
  EXPECT_THAT(painted(14), HasSubstr("topic11"));
  EXPECT_THAT(painted(14), Not(HasSubstr("others")));
  const std::string low = painted(6);
  EXPECT_THAT(low, HasSubstr("topic2 "));
  EXPECT_THAT(low, testing::ContainsRegex("9 others +2.2 kB"));
}

class Sizes : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Sizes, ShowWhatMatters) {
  const auto [width, height] = GetParam();
  GroundStationModel model;
  VehicleReport vehicle = report("Indoor Navigation");
  vehicle.armed = true;
  vehicle.height = 1.25;
  model.hear(vehicle, kBegin);
  model.hear(at(2.2, 4.4), kBegin);
  model.hear(BatteryReport{0.87, 15.9, 12.0, 3.0}, kBegin);
  model.note(kBegin, Severity::kNote, "something happened");
  const std::string screen = screen_of(model, kBegin, width, height);
  for (const char* text :
       {"Indoor Navigation", "ARMED", "87 %", "15 min", "1.25 m", "2.20 4.40", "speed", "GPS",
        "Health", "Map", "Events", "something happened", "? help"}) {
    EXPECT_THAT(screen, HasSubstr(text)) << screen;
  }
}
INSTANTIATE_TEST_SUITE_P(EachLayout, Sizes,
                         testing::Values(std::pair(60, 20), std::pair(80, 24), std::pair(119, 30),
                                         std::pair(120, 40), std::pair(200, 60)));

TEST(Layout, NoPartCoversAnotherAtAnySize) {
  for (int width = kLeastWidth; width <= 260; width += 7) {
    for (int height = kLeastHeight; height <= 90; height += 3) {
      for (const auto& [edits, values] :
           {std::pair(false, 6), std::pair(true, 6), std::pair(false, 7)}) {
        const Layout layout = layout_of(width, height, edits, values);
        std::vector<int> covered(static_cast<std::size_t>(width * height), 0);
        for (const Area& area :
             {layout.header, layout.flight, layout.health, layout.map, layout.waypoints,
              layout.events, layout.link, layout.message, layout.hints}) {
          for (int y = area.y; y < area.y + area.height; ++y) {
            for (int x = area.x; x < area.x + area.width; ++x) {
              ASSERT_TRUE(x >= 0 && y >= 0 && x < width && y < height) << width << "x" << height;
              ASSERT_EQ(covered[static_cast<std::size_t>(y * width + x)]++, 0)
                  << width << "x" << height << " at " << x << " " << y;
            }
          }
        }
        EXPECT_GE(layout.map.width, 30);
        EXPECT_GE(layout.map.height, 8);
        EXPECT_GE(edits ? layout.waypoints.height : layout.health.height, 2);
      }
    }
  }
}

TEST(Screen, SaysThatItIsTooSmall) {
  EXPECT_THAT(screen_of({}, kBegin, 59, 20), HasSubstr("too small: 59 x 20, needs 60 x 20"));
  screen_of({}, kBegin, 1, 1);
  screen_of({}, kBegin, 0, 0);
}

}  // namespace
}  // namespace swiftlet::screen
