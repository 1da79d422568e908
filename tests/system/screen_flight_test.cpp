// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The ground station's screen in a real terminal, beside a vehicle in four processes.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "tests/system/live_vehicle.hpp"
#include "tests/system/tmux_screen.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const Seconds kAnswer{3.0};  // two are promised

std::string content_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ScreenFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    if (!TmuxScreen::available()) GTEST_SKIP() << "there is no tmux (package tmux)";
    start_vehicle(office());
  }

  void open(int width, int height, const Process::Environment& more = {},
            const std::string& before = "") {
    Process::Environment environment = environment_;
    environment.insert(more.begin(), more.end());
    screen_ = std::make_unique<TmuxScreen>(before + SWIFTLET_PROGRAM + " gcs", width, height,
                                           environment, folder());
  }

  /// Where the cursor is by the title of the map.
  bool read_cursor(double& x, double& y) {
    const std::string text = screen_->text();
    const std::size_t at = text.find("cursor ");
    return at != std::string::npos && std::sscanf(text.c_str() + at, "cursor %lf %lf", &x, &y) == 2;
  }

  /// With the arrow keys, as a person would: look, move, look again.
  void move_cursor(double to_x, double to_y) {
    double x = 0.0;
    double y = 0.0;
    ASSERT_TRUE(becomes_true(kAnswer, [&] { return read_cursor(x, y); })) << screen_->text();
    const double before = x;
    screen_->press("Right");
    ASSERT_TRUE(becomes_true(kAnswer, [&] { return read_cursor(x, y) && x != before; }));
    const double step = x - before;
    const auto press = [&](double by, const char* plus, const char* minus) {
      const int times = static_cast<int>(std::lround(std::abs(by) / step));
      if (times > 0) screen_->press(by > 0 ? plus : minus, times);
    };
    const auto is_there = [&] {
      return read_cursor(x, y) && std::abs(x - to_x) < 0.6 * step &&
             std::abs(y - to_y) < 0.6 * step;
    };
    bool arrived = false;
    for (int look = 0; look < 3 && !arrived; ++look) {
      press(to_x - x, "Right", "Left");
      press(to_y - y, "Up", "Down");
      arrived = becomes_true(kAnswer, is_there);
    }
    ASSERT_TRUE(arrived) << "to " << to_x << " " << to_y << " by " << step << ":\n"
                         << screen_->text();
    EXPECT_LT(step, 0.6) << "a cursor that jumps";
  }

  /// A mission in place of an empty list.
  void put_together(const std::vector<std::pair<double, double>>& places) {
    screen_->press("w");
    for (const auto& [x, y] : places) {
      ASSERT_NO_FATAL_FAILURE(move_cursor(x, y));
      screen_->press("a");
    }
    ASSERT_TRUE(screen_->shows("  " + std::to_string(places.size()) + " ", kAnswer));
  }

  void clear_list() {
    screen_->press("c");
    ASSERT_TRUE(screen_->shows("of the list?", kAnswer));
    screen_->press("y");
    ASSERT_TRUE(screen_->shows("a: add", kAnswer));
  }

  /// What the vehicle says of its mission to somebody else.
  json mission() {
    const Finished finished = gcs({"mission", "status", "--json"});
    return finished.exit_code == 0 ? json::parse(finished.out) : json();
  }
  template <class Condition>
  bool mission_becomes(const std::string& what, Seconds limit, Condition condition) {
    json last;
    const bool done = becomes_true(limit, [&] {
      last = mission();
      return !last.is_null() && condition(last);
    });
    EXPECT_TRUE(done) << "never " << what << ": " << last.dump(2);
    return done;
  }

  void take_off() {
    screen_->press("a");
    ASSERT_TRUE(screen_->shows("The rotors will turn", kAnswer));
    screen_->press("y");
    ASSERT_TRUE(screen_->shows("arm: accepted", kAnswer));
    ASSERT_TRUE(screen_->shows("ARMED", kAnswer));
    screen_->press("t");
    screen_->press("Enter");
    ASSERT_TRUE(screen_->shows("takeoff: accepted", kAnswer));
    ends_in("Takeoff", "Hover", Seconds(20.0));
    ASSERT_TRUE(screen_->shows("Takeoff → Hover", kAnswer));
  }

  /// By the cursor on the map.
  void go_to(double x, double y) {
    screen_->press("g");
    ASSERT_NO_FATAL_FAILURE(move_cursor(x, y));
    screen_->press("Enter");
    ASSERT_TRUE(screen_->shows("goto: accepted", kAnswer));
    ends_in("Indoor Navigation", "Hover", Seconds(40.0));
    EXPECT_LT(distance(status(), x, y), 0.4);
  }

  void land() {
    screen_->press("l");
    ASSERT_TRUE(screen_->shows("land: accepted", kAnswer));
    ends_in("Land", "Grounded", Seconds(20.0));
    ASSERT_TRUE(screen_->shows("Grounded", kAnswer));
  }

  void quit() {
    screen_->press("q");
    EXPECT_TRUE(screen_->ended());
  }

  std::unique_ptr<TmuxScreen> screen_;
};

TEST_F(ScreenFlight, AWholeMissionIsFlownWithTheKeyboardAtEachSize) {
  open(60, 20);
  ASSERT_TRUE(screen_->shows("Grounded", kStartLimit));
  ASSERT_TRUE(becomes_ready());
  screen_->press("t");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("not armed", kAnswer)) << "a refusal says why";
  take_off();
  go_to(2.0, 1.0);

  screen_->resize(80, 24);
  ASSERT_TRUE(screen_->shows("battery", kAnswer)) << "drawn anew, with another step of the cursor";
  put_together({{2.0, 1.0}, {3.0, 1.0}, {4.0, 1.0}, {3.0, 1.0}, {2.2, 4.4}});
  screen_->press("s");
  ASSERT_TRUE(screen_->shows("upload: 5 items, read back", kAnswer));
  ASSERT_TRUE(screen_->shows("mission start: accepted", kAnswer));
  ASSERT_TRUE(screen_->shows("of 5 flying", kAnswer));
  ASSERT_TRUE(mission_becomes("at the second waypoint", Seconds(30.0),
                              [](const json& mission) { return mission["item"] >= 2; }));
  screen_->press("Space");
  ASSERT_TRUE(screen_->shows("mission pause: accepted", kAnswer));
  ASSERT_TRUE(screen_->shows("of 5 paused", kAnswer));
  EXPECT_EQ(status()["mode"], "Hover");
  const json paused = mission();
  EXPECT_EQ(paused["state"], "paused");

  // What the vehicle has comes back into an empty list.
  screen_->press("w");
  clear_list();
  screen_->press("d");
  ASSERT_TRUE(screen_->shows("download: 5 items", kAnswer));
  ASSERT_TRUE(screen_->shows("  5   2.", kAnswer));

  screen_->press("u");
  ASSERT_TRUE(screen_->shows("of 5 flying", kAnswer));
  EXPECT_GE(mission()["item"], paused["item"]) << "it goes on, and does not begin again";
  screen_->press("Escape");
  ends_in("Indoor Navigation", "Hover", Seconds(90.0));
  EXPECT_EQ(mission()["state"], "done");
  EXPECT_LT(distance(status(), 2.2, 4.4), 0.4);
  ASSERT_TRUE(screen_->shows("done, 5 items", kAnswer));

  screen_->press("w");
  screen_->press("v");
  screen_->press("y");
  ASSERT_TRUE(screen_->shows("mission  none", kAnswer));
  EXPECT_EQ(mission()["state"], "none");
  screen_->press("Escape");

  screen_->resize(200, 60);
  ASSERT_TRUE(screen_->shows("reports/s", kAnswer));
  go_to(2.0, 3.0);
  ASSERT_TRUE(screen_->shows("items done", kAnswer));
  land();
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, MissionsGoToFilesAndComeBack) {
  open(80, 24);
  ASSERT_TRUE(becomes_ready());
  ASSERT_TRUE(screen_->shows("ready to arm", kStartLimit));
  put_together({{2.0, 1.0}, {3.0, 1.0}, {4.0, 1.0}});
  screen_->press("s");
  ASSERT_TRUE(screen_->shows("not sent: item 1: it needs flight", kAnswer));
  EXPECT_EQ(mission()["state"], "none") << "nothing was sent";

  const std::string file = path("three.yaml");
  screen_->press("w");
  ASSERT_TRUE(screen_->shows("Write which file?", kAnswer));
  screen_->press(file);
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("3 items written", kAnswer));
  const std::string content = content_of(file);
  EXPECT_THAT(content, HasSubstr("goto: {x: 2, y: 1, z: 1.2}"));
  EXPECT_THAT(content, HasSubstr("goto: {x: 4, y: 1, z: 1.2}"));

  // A mission with all that the list cannot add itself, under a name that is remembered.
  const std::string everything =
      "items:\n  - takeoff: 1.3\n  - goto: {x: 2, y: 1, z: 1.2}\n  - hold: 4\n  - claw: close\n"
      "  - gps: {latitude: 47.4, longitude: 8.5, altitude: 10}\n  - return\n";
  write("three.yaml", everything);
  screen_->press("o");
  ASSERT_TRUE(screen_->shows("three.yaml_", kAnswer));
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("6 items read", kAnswer));
  for (const char* item : {"1 take off to 1.3 m", "3 hold 4 s", "4 close the claw", "5 gps"}) {
    EXPECT_TRUE(screen_->shows(item, kAnswer));
  }
  screen_->press("w");
  screen_->press("BSpace", 5);
  screen_->press("2.yaml");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("6 items written", kAnswer));
  EXPECT_EQ(content_of(path("three2.yaml")), everything);

  write("three2.yaml", "items:\n  - goto: {x: 2, y: 1}\n");
  screen_->press("o");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("three2.yaml:2", kAnswer)) << "file and line";
  ASSERT_TRUE(screen_->shows("1 take off to 1.3 m", kAnswer)) << "the list stays";
  screen_->press("Escape");
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, ParametersChangeAndControlIsHandedOver) {
  open(80, 24);
  ASSERT_TRUE(screen_->shows("Grounded", kStartLimit));
  ASSERT_TRUE(becomes_ready());
  screen_->press("p");
  ASSERT_TRUE(screen_->shows("commander", kAnswer));
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("ground min_altitude", kAnswer)) << "the first, before lift-off";
  ASSERT_TRUE(screen_->shows("always landing_speed", kAnswer));
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("0.3_", kAnswer));
  screen_->press("BSpace");
  screen_->press("4");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("commander.min_altitude is now 0.4", kAnswer));
  screen_->press("Escape");
  screen_->press("Escape");

  screen_->press("k");
  ASSERT_TRUE(screen_->shows("control: here", kAnswer));
  const std::string station = status()["control"];
  const Finished refused = gcs({"arm", "--station", "tablet"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("has control, not 'tablet'"));
  screen_->press("k");
  ASSERT_TRUE(screen_->shows("Give control to which station", kAnswer));
  screen_->press("tablet");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("control: tablet", kAnswer));
  screen_->press("a");
  screen_->press("y");
  ASSERT_TRUE(screen_->shows("station 'tablet' has control", kAnswer)) << "who has it, and why not";
  EXPECT_EQ(gcs({"control", "give", station, "--station", "tablet"}).exit_code, 0);
  ASSERT_TRUE(screen_->shows("control: here", kAnswer));
  screen_->press("v");
  ASSERT_TRUE(screen_->shows("control: tablet has it", kAnswer)) << "all events";
  screen_->press("Escape");
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, AClawIsOpenedAndClosedOnceThereIsOne) {
  std::string scenario = content_of(office());
  const std::string worlds = "../worlds";
  scenario.replace(scenario.find(worlds), worlds.size(),
                   std::filesystem::path(office()).parent_path() / worlds);
  const std::string with_claw = write("claw.yaml", scenario + "\nclaw: {}\n");
  open(80, 24);
  ASSERT_TRUE(screen_->shows("Grounded", kStartLimit));
  screen_->press("c");
  ASSERT_TRUE(screen_->shows("no claw is heard", kAnswer));
  EXPECT_THAT(screen_->text(), Not(HasSubstr("claw     ")));
  processes_.push_back(start({"run", "claw", "sim_claw", "--scenario", with_claw}));
  ASSERT_TRUE(screen_->shows("claw     not moved yet", kStartLimit));
  screen_->press("c");
  ASSERT_TRUE(screen_->shows("claw     closed", kAnswer));
  screen_->press("o");
  ASSERT_TRUE(screen_->shows("claw     open", kAnswer));
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, ShowsWhatMattersAtEachSizeAndWhileItIsResized) {
  open(60, 20);
  ASSERT_TRUE(becomes_ready());
  const auto shows_all = [this] {
    for (const char* text : {"Grounded", "disarmed", "link", "%", "height", "speed", "position",
                             "heading", "GPS", "Health", "ready to arm", "Map", "Events", "help"}) {
      EXPECT_TRUE(screen_->shows(text, kAnswer));
    }
  };
  ASSERT_TRUE(screen_->shows("ready to arm", kStartLimit));
  shows_all();
  screen_->resize(59, 20);
  EXPECT_TRUE(screen_->shows("too small: 59 x 20", kAnswer));
  screen_->press("?");  // is not heard there: the next one would close the help
  screen_->resize(80, 24);
  EXPECT_TRUE(screen_->shows("battery", kAnswer));
  shows_all();
  screen_->press("?");
  EXPECT_TRUE(screen_->shows("take off (asks how high)", kAnswer));
  screen_->press("Escape");
  screen_->resize(200, 60);
  EXPECT_TRUE(screen_->shows("Waypoints", kAnswer));
  EXPECT_TRUE(screen_->shows("reports/s", kAnswer));
  shows_all();
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, APlainTerminalIsEnough) {
  open(80, 24, {{"LC_ALL", "C"}}, "TERM=vt100 ");
  ASSERT_TRUE(screen_->shows("Grounded", kStartLimit));
  ASSERT_TRUE(screen_->shows("help", kAnswer));
  for (const char c : screen_->text()) {
    ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F)) << screen_->text();
  }
  quit();
  stop_vehicle();
}

TEST_F(ScreenFlight, WhatFallsSilentIsStaleWithinASecondAndComesBack) {
  open(80, 24);
  ASSERT_TRUE(becomes_ready());
  ASSERT_TRUE(screen_->shows("ready to arm", kStartLimit));
  EXPECT_THAT(screen_->text(), Not(HasSubstr("stale")));
  processes_.at(1).send(SIGKILL);  // estimator
  ASSERT_TRUE(processes_.at(1).wait(kExitLimit));
  // A second, and a picture, and a look at it.
  ASSERT_TRUE(screen_->shows("stale: ", Seconds(1.5)));
  processes_.at(1) = start(hosts_.at(1));
  ASSERT_TRUE(becomes_true(Seconds(15.0), [&] {
    return screen_->text().find("stale") == std::string::npos;
  })) << screen_->text();
  processes_.at(3).send(SIGKILL);  // commander
  ASSERT_TRUE(processes_.at(3).wait(kExitLimit));
  ASSERT_TRUE(screen_->shows("LINK LOST", Seconds(1.5)));
  processes_.at(3) = start(hosts_.at(3));
  // That it is back is among the events, too, but many others follow.
  ASSERT_TRUE(becomes_true(Seconds(15.0), [&] {
    return screen_->text().find("LINK LOST") == std::string::npos;
  })) << screen_->text();
  EXPECT_TRUE(screen_->shows("Grounded", kAnswer));
  quit();
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
