// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Kind = Action::Kind;

const Time kBegin(1000s);

class ControllerTest : public testing::Test {
 protected:
  ControllerTest() {
    circumstances.now = kBegin;
    circumstances.vehicle = Eigen::Vector3d(1.0, 2.0, 1.5);
    circumstances.in_flight = true;
    circumstances.check.on_ground = false;
    circumstances.components = {"estimator", "planner"};
  }

  std::vector<Kind> press(KeyCode key) {
    std::vector<Kind> kinds;
    for (const Action& action : controller.press(key, circumstances)) {
      kinds.push_back(action.kind);
      last = action;
    }
    return kinds;
  }
  std::vector<Kind> press(const std::string& keys) {
    std::vector<Kind> kinds;
    for (const char c : keys) {
      for (const Kind kind : press(key_code(static_cast<unsigned char>(c)))) kinds.push_back(kind);
    }
    return kinds;
  }

  /// In place of what an entry has.
  std::vector<Kind> write(const std::string& text) {
    while (!controller.text().empty()) press(KeyCode::kBackspace);
    press(text);
    return press(KeyCode::kEnter);
  }

  Controller controller;
  Circumstances circumstances;
  Action last;
};

TEST_F(ControllerTest, CommandsThatMustNotWaitAreOneKey) {
  EXPECT_THAT(press("l"), ElementsAre(Kind::kLand));
  EXPECT_THAT(press("h"), ElementsAre(Kind::kHover));
  EXPECT_THAT(press(" "), ElementsAre(Kind::kHover));
  EXPECT_THAT(press("r"), ElementsAre(Kind::kReturn));
  EXPECT_THAT(press("e"), ElementsAre(Kind::kExplore));
  EXPECT_THAT(press("d"), ElementsAre(Kind::kDisarm));
}

TEST_F(ControllerTest, ArmingAsksFirst) {
  EXPECT_THAT(press("a"), IsEmpty());
  EXPECT_EQ(controller.keyboard(), Keyboard::kConfirm);
  EXPECT_THAT(press("lx"), IsEmpty()) << "only the answer counts";
  EXPECT_THAT(press("n"), IsEmpty());
  EXPECT_THAT(press("ay"), ElementsAre(Kind::kArm));
  EXPECT_EQ(controller.keyboard(), Keyboard::kFly);
}

TEST_F(ControllerTest, TakeoffAsksHowHigh) {
  EXPECT_THAT(press("t"), IsEmpty());
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kTakeoff));
  EXPECT_EQ(last.altitude, kUsualAltitude);
  press("t");
  for (int i = 0; i < 5; ++i) press(KeyCode::kBackspace);
  EXPECT_THAT(press(KeyCode::kEnter), IsEmpty()) << "nothing is no height";
  press("2.5x");
  EXPECT_THAT(press(KeyCode::kEnter), IsEmpty());
  press(KeyCode::kBackspace);
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kTakeoff));
  EXPECT_EQ(last.altitude, 2.5);
  press("t9");
  EXPECT_THAT(press(KeyCode::kEscape), IsEmpty());
  EXPECT_EQ(controller.keyboard(), Keyboard::kFly);
}

TEST_F(ControllerTest, QuittingAsksOnlyInFlight) {
  EXPECT_THAT(press("q"), IsEmpty());
  EXPECT_THAT(press("y"), ElementsAre(Kind::kQuit));
  circumstances.in_flight = false;
  EXPECT_THAT(press("q"), ElementsAre(Kind::kQuit));
}

TEST_F(ControllerTest, TheCursorBeginsAtTheVehicleAndFliesThere) {
  press("g");
  ASSERT_TRUE(controller.cursor());
  EXPECT_TRUE(controller.cursor()->isApprox(Eigen::Vector2d(1.0, 2.0)));
  const double step = controller.camera().cursor_step();
  for (int i = 0; i < 3; ++i) press(KeyCode::kRight);
  press(KeyCode::kUp);
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kGoTo));
  EXPECT_TRUE(last.place.isApprox(Eigen::Vector3d(1.0 + 3 * step, 2.0 + step, 1.5)))
      << "at the height that it has";
  EXPECT_FALSE(controller.cursor());
  press("g");
  press(KeyCode::kRight);
  EXPECT_THAT(press(KeyCode::kEscape), IsEmpty());
}

TEST_F(ControllerTest, WaypointsAreEditedInPlaceAndFlownAsOneMission) {
  const auto east_of = [&](std::size_t i) {
    return controller.waypoints().items().at(i).item.place.position.x();
  };
  press("w");
  EXPECT_THAT(press("s"), ElementsAre(Kind::kTell));
  EXPECT_THAT(last.text, HasSubstr("the list is empty"));
  const double step = controller.camera().cursor_step();
  for (int i = 0; i < 3; ++i) {
    press("a");
    press(KeyCode::kRight);
  }
  ASSERT_EQ(controller.waypoints().items().size(), 3u);
  EXPECT_EQ(controller.waypoints().selected(), 2);
  press("[");  // 0 2 1
  EXPECT_NEAR(east_of(1), 1.0 + 2 * step, 1e-9);
  press("]");  // 0 1 2
  EXPECT_NEAR(east_of(2), 1.0 + 2 * step, 1e-9);
  press("bbi");  // in front of the first
  ASSERT_EQ(controller.waypoints().items().size(), 4u);
  EXPECT_NEAR(east_of(0), 1.0 + 3 * step, 1e-9);
  EXPECT_EQ(controller.waypoints().selected(), 0);
  press("nx");  // without the second
  ASSERT_EQ(controller.waypoints().items().size(), 3u);
  EXPECT_NEAR(east_of(1), 1.0 + step, 1e-9);
  press(KeyCode::kUp);
  press("m");
  EXPECT_NEAR(controller.waypoints().items()[1].item.place.position.y(), 2.0 + step, 1e-9);
  press("z");
  write("0.9");
  EXPECT_NEAR(controller.waypoints().items()[1].item.place.position.z(), 0.9, 1e-9);
  EXPECT_THAT(press("s"), testing::Contains(Kind::kFlyMission));
  EXPECT_EQ(last.mission.items.size(), 3u);
  EXPECT_EQ(controller.keyboard(), Keyboard::kFly);
  press("wcn");
  EXPECT_EQ(controller.waypoints().items().size(), 3u);
  press("cy");
  EXPECT_TRUE(controller.waypoints().empty());
  EXPECT_EQ(controller.keyboard(), Keyboard::kWaypoints);
}

TEST_F(ControllerTest, WhatCannotBeFlownIsNotSentAndTheItemIsShown) {
  press("waaa");
  press("b");
  press("z");
  write("1e6");
  press("n");
  EXPECT_EQ(controller.waypoints().selected(), 2);
  const auto kinds = press("s");
  EXPECT_THAT(kinds, Not(testing::Contains(Kind::kFlyMission)));
  EXPECT_EQ(kinds.back(), Kind::kTell);
  EXPECT_EQ(last.severity, Severity::kDanger);
  EXPECT_THAT(last.text, testing::StartsWith("not sent: item 2: "));
  EXPECT_EQ(controller.waypoints().selected(), 1);
  EXPECT_EQ(controller.keyboard(), Keyboard::kWaypoints) << "to be put right";

  circumstances.check.on_ground = true;
  press("z");
  write("1.2");
  press("s");
  EXPECT_THAT(last.text, testing::HasSubstr("begin with a take-off"));
}

TEST_F(ControllerTest, WhatIsInsideAnObstacleOfTheMapIsNotSent) {
  auto map = std::make_shared<GridMap>();
  map->width = map->height = 80;
  map->resolution = 0.05;
  map->cells.assign(80 * 80, 0);
  circumstances.map = map;
  press("wa");
  const Eigen::Vector2d place = controller.waypoints().items()[0].item.place.position.head<2>();
  EXPECT_THAT(press("s"), testing::Contains(Kind::kFlyMission)) << "all is free";
  const Eigen::Vector2i cell = (place / 0.05).cast<int>();
  map->cells[static_cast<std::size_t>(80 * cell.y() + cell.x())] = 100;
  press("w");
  EXPECT_THAT(press("s"), Not(testing::Contains(Kind::kFlyMission)));
  EXPECT_THAT(last.text, testing::HasSubstr("is inside an obstacle"));
}

TEST_F(ControllerTest, SpacePausesAMissionThatFliesAndGoingOnIsOneKey) {
  for (const char* keyboard : {"", "g", "w"}) {
    press(keyboard);
    circumstances.mission_flies = false;
    EXPECT_THAT(press(" "), ElementsAre(Kind::kHover)) << keyboard;
    circumstances.mission_flies = true;
    EXPECT_THAT(press(" "), ElementsAre(Kind::kPauseMission)) << keyboard;
    EXPECT_THAT(press("u"), ElementsAre(Kind::kGoOn)) << keyboard;
    press(KeyCode::kEscape);
  }
  EXPECT_THAT(press("h"), ElementsAre(Kind::kPauseMission));
}

TEST_F(ControllerTest, AMissionThatIsDoneIsNotGoneOnWith) {
  circumstances.mission_done = true;
  for (const char* keyboard : {"", "g", "w"}) {
    press(keyboard);
    EXPECT_THAT(press("u"), ElementsAre(Kind::kTell)) << keyboard;
    EXPECT_THAT(last.text, HasSubstr("the mission is done"));
    press(KeyCode::kEscape);
  }
}

TEST_F(ControllerTest, TheClawIsNotOpenedInFlightByMistake) {
  EXPECT_THAT(press("c"), ElementsAre(Kind::kCloseClaw));
  EXPECT_THAT(press("o"), IsEmpty());
  EXPECT_THAT(press("n"), IsEmpty());
  EXPECT_THAT(press("oy"), ElementsAre(Kind::kOpenClaw));
  circumstances.in_flight = false;
  EXPECT_THAT(press("o"), ElementsAre(Kind::kOpenClaw));
}

TEST_F(ControllerTest, FilesAreNamedAndTheLastNameIsRemembered) {
  press("w");
  EXPECT_THAT(press("w"), IsEmpty());
  EXPECT_EQ(controller.keyboard(), Keyboard::kWaypoints) << "nothing to write";
  press("o");
  EXPECT_THAT(press(KeyCode::kEnter), IsEmpty()) << "it has no name";
  EXPECT_EQ(controller.keyboard(), Keyboard::kText);
  EXPECT_THAT(write("yard.plan"), ElementsAre(Kind::kLoad));
  EXPECT_EQ(last.file, "yard.plan");
  press("aw");
  EXPECT_EQ(controller.text(), "yard.plan");
  press(KeyCode::kEraseLine);
  EXPECT_EQ(controller.text(), "");
  EXPECT_THAT(write("b.yaml"), ElementsAre(Kind::kSave));
  EXPECT_EQ(last.file, "b.yaml");
  EXPECT_FALSE(last.replaces);
  controller.waypoints().set_kept("b.yaml");
  press("w");
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kSave));
  EXPECT_TRUE(last.replaces) << "its own file";
}

TEST_F(ControllerTest, AListIsReplacedUnaskedOnlyWhereNothingIsLost) {
  press("w");
  EXPECT_THAT(press("d"), ElementsAre(Kind::kFetchMission)) << "it is empty";
  press("aa");
  EXPECT_THAT(press("d"), IsEmpty());
  EXPECT_THAT(press("n"), IsEmpty());
  EXPECT_THAT(press("dy"), ElementsAre(Kind::kFetchMission));
  press("o");
  EXPECT_THAT(write("b.yaml"), IsEmpty());
  EXPECT_THAT(press("y"), ElementsAre(Kind::kLoad));
  EXPECT_EQ(last.file, "b.yaml");
  controller.waypoints().set_kept("b.yaml");
  EXPECT_THAT(press("d"), ElementsAre(Kind::kFetchMission));
  press("m");
  EXPECT_THAT(press("d"), IsEmpty()) << "it was edited";
}

TEST_F(ControllerTest, ClearingTheVehiclesMissionAsks) {
  press("wa");
  EXPECT_THAT(press("v"), IsEmpty());
  EXPECT_THAT(press("y"), ElementsAre(Kind::kClearMission));
  EXPECT_EQ(controller.waypoints().size(), 1u) << "the list is another thing";
  EXPECT_THAT(press("vn"), IsEmpty());
}

TEST_F(ControllerTest, SticksGoBackWhenNoKeyComes) {
  EXPECT_FALSE(controller.sticks(kBegin));
  EXPECT_THAT(press("m"), ElementsAre(Kind::kManual));
  EXPECT_EQ(controller.sticks(kBegin)->deflection(), 0.0);
  press("w");
  EXPECT_EQ(controller.sticks(kBegin + 100ms)->forward, 1.0);
  EXPECT_EQ(controller.sticks(kBegin + KeySticks::kHold)->deflection(), 0.0);
}

TEST_F(ControllerTest, KeysThatFlyGiveNoCommands) {
  press("m");
  EXPECT_THAT(press("wsadikjlmtrheq "), IsEmpty());
  EXPECT_EQ(controller.keyboard(), Keyboard::kSticks);
  EXPECT_THAT(press(KeyCode::kEscape), ElementsAre(Kind::kHover));
  EXPECT_FALSE(controller.sticks(kBegin));
}

TEST_F(ControllerTest, KeysThatFlyDoWhatTheTableSays) {
  press("m");
  const auto sticks_after = [this](char c) {
    press(" ");
    press(std::string(1, c));
    return *controller.sticks(kBegin);
  };
  for (const Binding& binding : key_bindings()) {
    if (binding.keyboards != std::vector{Keyboard::kSticks}) continue;
    const char key = static_cast<char>(binding.keys.front());
    const std::string what = binding.what;
    if (what == "Manual or Assisted Manual") continue;
    const Sticks sticks = sticks_after(key);
    const std::map<std::string, double> by_name{
        {"forward", sticks.forward}, {"back", -sticks.forward},   {"left", sticks.left},
        {"right", -sticks.left},     {"up", sticks.up},           {"down", -sticks.up},
        {"turn left", sticks.turn},  {"turn right", -sticks.turn}};
    const auto found = by_name.find(what);
    if (found != by_name.end()) {
      EXPECT_EQ(found->second, 1.0) << what;
    }
    if (what == "let go of the sticks") {
      press("w");
      EXPECT_EQ(sticks_after(key).deflection(), 0.0);
    }
  }
}

TEST_F(ControllerTest, ParametersAreChosenAndChanged) {
  press("p");
  press(KeyCode::kDown);
  press(KeyCode::kDown);
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kListParameters));
  EXPECT_EQ(last.component, "planner");
  EXPECT_THAT(press(KeyCode::kEnter), IsEmpty()) << "there is no answer yet";
  using Changes = ParameterEntry::Changes;
  controller.parameters().entries = {{"seed", "1", "", Changes::kAtStart},
                                     {"max_speed", "1.5", "", Changes::kAtAnyTime},
                                     {"altitude", "2", "", Changes::kOnGround}};
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kTell)) << "it cannot be changed";
  EXPECT_THAT(last.text, HasSubstr("when the component starts"));
  press(KeyCode::kDown);
  press(KeyCode::kEnter);
  EXPECT_EQ(controller.text(), "1.5");
  press(KeyCode::kBackspace);
  press("2");
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kSetParameter));
  EXPECT_EQ(last.name, "max_speed");
  EXPECT_EQ(last.value, "1.2");
  press(KeyCode::kDown);
  circumstances.in_flight = true;
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kTell)) << "too late";
  circumstances.in_flight = false;
  EXPECT_THAT(press(KeyCode::kEnter), IsEmpty());
  EXPECT_EQ(controller.text(), "2");
  press(KeyCode::kEscape);
  press(KeyCode::kEscape);
  EXPECT_TRUE(controller.parameters().component.empty());
  press(KeyCode::kEscape);
  EXPECT_EQ(controller.keyboard(), Keyboard::kFly);
}

TEST_F(ControllerTest, PlacesOnEarthAreTyped) {
  EXPECT_THAT(press("G"), IsEmpty());
  EXPECT_THAT(write("47.5"), IsEmpty()) << "half of a place";
  EXPECT_THAT(write("47.5 eight"), IsEmpty());
  EXPECT_THAT(write("47.5, -8.25 12"), ElementsAre(Kind::kGoToGlobal));
  EXPECT_EQ(last.global.latitude, 47.5);
  EXPECT_EQ(last.global.longitude, -8.25);
  EXPECT_EQ(last.global.altitude, 12.0);
  press("G");
  EXPECT_THAT(write("47.5 8"), ElementsAre(Kind::kGoToGlobal));
  EXPECT_EQ(last.global.altitude, 0.0) << "the usual one";
}

TEST_F(ControllerTest, AMissionFromTheGroundIsPutTogetherByKeysAlone) {
  circumstances.in_flight = false;
  circumstances.check.on_ground = true;
  press("war");
  EXPECT_THAT(press("s"), Contains(Kind::kTell)) << "it has no take-off";
  press("tG");
  write("47.5 8 20");
  const auto& items = controller.waypoints().items();
  ASSERT_EQ(items.size(), 4U);
  EXPECT_EQ(items[0].item.kind, MissionItem::Kind::kTakeoff);
  EXPECT_EQ(items[1].item.kind, MissionItem::Kind::kWaypoint);
  EXPECT_TRUE(items[2].item.global) << "before the return";
  EXPECT_EQ(items[3].item.kind, MissionItem::Kind::kReturn);
  press("l");
  EXPECT_EQ(items.size(), 4U) << "a landing in place of the return";
  EXPECT_EQ(items.back().item.kind, MissionItem::Kind::kLand);
  press("t");
  EXPECT_EQ(items.size(), 4U) << "there is one";
  EXPECT_THAT(press("s"), Contains(Kind::kFlyMission));
}

TEST_F(ControllerTest, EventsAndTheLinkAreViewed) {
  press("v");
  EXPECT_EQ(controller.keyboard(), Keyboard::kEvents);
  EXPECT_EQ(controller.events_up(), 0);
  press(KeyCode::kUp);
  const int up = controller.events_up();
  EXPECT_GT(up, 0);
  press(KeyCode::kUp);
  EXPECT_GT(controller.events_up(), up);
  for (int i = 0; i < 3; ++i) press(KeyCode::kDown);
  EXPECT_EQ(controller.events_up(), 0);
  press(KeyCode::kEscape);
  press("b");
  EXPECT_EQ(controller.keyboard(), Keyboard::kLink);
  press(KeyCode::kEscape);
  EXPECT_EQ(controller.keyboard(), Keyboard::kFly);
}

TEST_F(ControllerTest, ControlIsTakenAndGivenAway) {
  EXPECT_THAT(press("k"), ElementsAre(Kind::kTakeControl));
  circumstances.has_control = true;
  EXPECT_THAT(press("k"), IsEmpty()) << "asks to whom";
  press("base");
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kGiveControl));
  EXPECT_EQ(last.name, "base");
  press("k");
  EXPECT_THAT(press(KeyCode::kEnter), ElementsAre(Kind::kReleaseControl));
  press("k");
  EXPECT_THAT(press(KeyCode::kEscape), IsEmpty()) << "kept";
}

TEST(KeyBindings, NoKeyDoesTwoThings) {
  std::set<std::pair<Keyboard, KeyCode>> seen;
  for (const Binding& binding : key_bindings()) {
    for (const Keyboard keyboard : binding.keyboards) {
      for (const KeyCode key : binding.keys) {
        EXPECT_TRUE(seen.insert({keyboard, key}).second)
            << to_string(keyboard) << ": " << binding.label << " " << binding.what;
      }
    }
  }
}

TEST(KeyBindings, EveryKeyboardCanBeLeft) {
  for (const Keyboard keyboard : kKeyboards) {
    if (keyboard == Keyboard::kFly) continue;
    const Binding* binding = find_binding(keyboard, KeyCode::kEscape);
    ASSERT_NE(binding, nullptr) << to_string(keyboard);
    EXPECT_EQ(binding->deed, Deed::kLeave);
  }
}

/// As gcs/README.md shows it.
std::string table_row(const Binding& binding) {
  std::string where;
  for (const Keyboard keyboard : binding.keyboards) {
    where += (where.empty() ? "" : ", ") + std::string(to_string(keyboard));
  }
  return "| " + where + " | `" + binding.label + "` | " + binding.what + " |";
}

TEST(KeyBindings, AreInTheReadme) {
  std::ifstream file(SWIFTLET_SOURCE_DIR "/gcs/README.md");
  std::stringstream text;
  text << file.rdbuf();
  std::string table;
  for (const Binding& binding : key_bindings()) table += table_row(binding) + "\n";
  EXPECT_NE(text.str().find(table), std::string::npos)
      << "the table of keys in gcs/README.md must be:\n"
      << table;
}

}  // namespace
}  // namespace swiftlet::screen
