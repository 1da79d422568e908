// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The ground station's screen in a real terminal, beside a vehicle in four processes.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>

#include "tests/system/live_vehicle.hpp"
#include "tests/system/tmux_screen.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const Seconds kAnswer{3.0};  // two are promised

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
    press(to_x - x, "Right", "Left");
    press(to_y - y, "Up", "Down");
    ASSERT_TRUE(becomes_true(kAnswer,
                             [&] {
                               return read_cursor(x, y) && std::abs(x - to_x) < 0.6 * step &&
                                      std::abs(y - to_y) < 0.6 * step;
                             }))
        << "to " << to_x << " " << to_y << " by " << step << ":\n"
        << screen_->text();
    EXPECT_LT(step, 0.6) << "a cursor that jumps";
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

TEST_F(ScreenFlight, AWholeMissionIsFlownWithTheKeyboard) {
  open(80, 24);
  ASSERT_TRUE(screen_->shows("Grounded", kStartLimit));
  ASSERT_TRUE(becomes_ready());
  screen_->press("t");
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("not armed", kAnswer)) << "a refusal says why";
  take_off();

  screen_->press("w");
  const double places[][2] = {{2.0, 1.0}, {3.0, 1.0}, {4.0, 1.0}, {3.0, 1.0}, {2.2, 4.4}};
  for (const auto& [x, y] : places) {
    move_cursor(x, y);
    screen_->press("a");
  }
  ASSERT_TRUE(screen_->shows("  5 ", kAnswer));
  screen_->press("s");
  ASSERT_TRUE(screen_->shows("mission of 5: accepted", kAnswer));
  ASSERT_TRUE(screen_->shows("of 5", kAnswer));
  ASSERT_TRUE(status_becomes("at the second waypoint", Seconds(30.0),
                             [](const json& s) { return s["mission"]["waypoint"] >= 2; }));
  screen_->press("Space");
  ASSERT_TRUE(screen_->shows("hover: accepted", kAnswer));
  EXPECT_EQ(status()["mode"], "Hover");

  screen_->press("w");
  screen_->press("s");
  ASSERT_TRUE(screen_->shows("mission of 5: accepted", kAnswer));
  ends_in("Indoor Navigation", "Hover", Seconds(90.0));
  json now = status();
  EXPECT_EQ(now["mission"]["done"], true) << now.dump(2);
  EXPECT_LT(distance(now, 2.2, 4.4), 0.4);

  screen_->press("g");
  move_cursor(2.0, 3.0);
  screen_->press("Enter");
  ASSERT_TRUE(screen_->shows("goto: accepted", kAnswer));
  ends_in("Indoor Navigation", "Hover", Seconds(40.0));
  EXPECT_LT(distance(status(), 2.0, 3.0), 0.4);
  screen_->resize(200, 60);
  ASSERT_TRUE(screen_->shows("mission done", kAnswer));
  land();
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
