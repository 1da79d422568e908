// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "components/joystick/joystick_axes.hpp"
#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;

input_event event(int type, int code, int value) {
  input_event e{};
  e.type = static_cast<std::uint16_t>(type);
  e.code = static_cast<std::uint16_t>(code);
  e.value = value;
  return e;
}

TEST(JoystickAxes, SticksPointWhereTheyArePushed) {
  JoystickAxes axes{JoystickAxes::Params{}};
  EXPECT_EQ(axes.sticks().deflection(), 0.0) << "what was not heard is at its centre";
  axes.hear(event(EV_ABS, ABS_RY, -32768));  // away from the body
  axes.hear(event(EV_ABS, ABS_RX, 32767));   // to the right
  axes.hear(event(EV_ABS, ABS_Y, 32767));    // towards the body
  axes.hear(event(EV_ABS, ABS_X, -32768));   // to the left
  const Sticks sticks = axes.sticks();
  EXPECT_NEAR(sticks.forward, 1.0, 1e-4);
  EXPECT_NEAR(sticks.left, -1.0, 1e-4);
  EXPECT_NEAR(sticks.up, -1.0, 1e-4);
  EXPECT_NEAR(sticks.turn, 1.0, 1e-4);
}

TEST(JoystickAxes, AnAxisHasTheRangeThatItSays) {
  JoystickAxes axes{JoystickAxes::Params{}};
  axes.set_range(ABS_RY, 0, 255);
  axes.set_range(ABS_RX, 7, 7);  // none
  axes.hear(event(EV_ABS, ABS_RY, 0));
  axes.hear(event(EV_ABS, ABS_RX, 32767));
  EXPECT_EQ(axes.sticks().forward, 1.0);
  EXPECT_NEAR(axes.sticks().left, -1.0, 1e-4);
  axes.hear(event(EV_ABS, ABS_RY, 4000));
  EXPECT_EQ(axes.sticks().forward, -1.0) << "and no more than that";
}

TEST(JoystickAxes, TheButtonSwitchesOnceEachTimeThatItIsPressed) {
  JoystickAxes axes{JoystickAxes::Params{}};
  for (const int value : {1, 2, 2, 0}) axes.hear(event(EV_KEY, BTN_SOUTH, value));
  EXPECT_TRUE(axes.sticks().assisted);
  axes.hear(event(EV_KEY, BTN_EAST, 1));
  EXPECT_TRUE(axes.sticks().assisted);
  axes.hear(event(EV_KEY, BTN_SOUTH, 1));
  EXPECT_FALSE(axes.sticks().assisted);
}

/// A pipe in the place of the device: it carries the same events, but does not know its ranges.
TEST(Joystick, SaysWhereTheSticksAreWhileItIsThere) {
  const std::filesystem::path device =
      std::filesystem::temp_directory_path() / ("joystick-" + std::to_string(getpid()));
  ASSERT_EQ(mkfifo(device.c_str(), 0600), 0);
  int file = open(device.c_str(), O_RDWR | O_NONBLOCK);
  ASSERT_GE(file, 0);
  Bench bench("joystick", "device: " + device.string());
  auto& heard = bench.record(topic::manual_control);
  const input_event forward = event(EV_ABS, ABS_RY, -16384);
  bench.probe.call_at(Time(500ms), [&](Time) {
    ASSERT_EQ(write(file, &forward, sizeof(forward)), static_cast<ssize_t>(sizeof(forward)));
  });
  std::size_t heard_then = 0;
  bench.probe.call_at(Time(1s), [&](Time) {
    heard_then = heard.size();
    close(file);
    std::filesystem::remove(device);
  });
  bench.run_until(Time(3s));
  ASSERT_GE(heard_then, 15u);
  EXPECT_EQ(heard.front().forward(), 0.0f);
  EXPECT_NEAR(heard[heard_then - 1].forward(), 0.5f, 0.01f);
  EXPECT_LE(heard.size(), heard_then + 1) << "silent once it is gone";
}

TEST(Joystick, WaitsForADeviceThatIsNotThere) {
  Bench bench("joystick", "device: /nowhere/event7");
  auto& heard = bench.record(topic::manual_control);
  auto& status = bench.record(topic::component_status);
  bench.run_until(Time(3s));
  EXPECT_TRUE(heard.empty());
  ASSERT_FALSE(status.empty());
  EXPECT_THAT(status.back().problems(),
              testing::Contains(testing::HasSubstr("/nowhere/event7 cannot be opened")));
}

}  // namespace
}  // namespace swiftlet::test
