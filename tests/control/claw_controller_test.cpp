// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The claw's controller with the simulator's servo.
#include "control/claw_controller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "components/sim/claw_servo.hpp"

namespace swiftlet {
namespace {

using ::testing::HasSubstr;
using State = ClawController::State;

constexpr Duration kTick = std::chrono::milliseconds(20);

struct Rig {
  ClawController controller;
  ClawServo servo;
  ClawController::Params params;
  Time now{std::chrono::seconds(10)};
  bool connected = true;  // feedback comes
  double noise = 0.0;     // of the current [A]
  std::mt19937 random{11};
  std::optional<double> pulse;
  double largest_current = 0.0;
  double largest_step = 0.0;  // of the pulse [us]

  explicit Rig(const ClawServo::Params& servo_params = {},
               const ClawController::Params& controller_params = {})
      : controller(controller_params), servo(servo_params), params(controller_params) {}

  void tick() {
    now += kTick;
    std::normal_distribution<double> error(0.0, 1.0);
    if (connected) {
      controller.set_feedback(servo.position_us(), servo.current() + noise * error(random), now);
    }
    const std::optional<double> before = pulse;
    pulse = controller.tick(now);
    if (before && pulse) largest_step = std::max(largest_step, std::abs(*pulse - *before));
    if (pulse) servo.set_pulse(*pulse);
    servo.step(kTick);
    largest_current = std::max(largest_current, servo.current());
  }
  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += to_seconds(kTick)) tick();
  }
  /// Tells it again and again, as the commander does.
  void told(bool open, double seconds) {
    for (double t = 0.0; t < seconds; t += to_seconds(kTick)) {
      controller.command(open, now);
      tick();
    }
  }
};

ClawServo::Params with_object(double opening) {
  ClawServo::Params params;
  params.object = true;
  params.object_opening = opening;
  return params;
}

TEST(ClawController, LeavesTheServoAloneUntilItIsTold) {
  Rig rig(with_object(0.4));
  rig.run(2.0);
  EXPECT_FALSE(rig.pulse);
  EXPECT_EQ(rig.controller.state(), State::kUnknown);
  EXPECT_EQ(rig.servo.opening(), 1.0);
}

TEST(ClawController, OpensAndClosesInItsTravelTimeAndNoFaster) {
  for (const bool reversed : {false, true}) {
    ClawServo::Params servo;
    ClawController::Params params;
    if (reversed) {
      std::swap(servo.pulse_open_us, servo.pulse_closed_us);
      std::swap(params.pulse_open_us, params.pulse_closed_us);
    }
    servo.start_opening = 0.0;
    Rig rig(servo, params);
    rig.told(true, 0.5);
    EXPECT_EQ(rig.controller.state(), State::kOpening);
    rig.told(true, 0.5);
    EXPECT_EQ(rig.controller.state(), State::kOpen);
    EXPECT_NEAR(*rig.controller.opening(rig.now), 1.0, 0.03);
    rig.told(false, 0.5);
    EXPECT_EQ(rig.controller.state(), State::kClosing);
    rig.told(false, 0.5);
    EXPECT_EQ(rig.controller.state(), State::kClosed);
    EXPECT_NEAR(rig.servo.opening(), 0.0, 0.03);
    EXPECT_LE(rig.largest_step, 1000.0 / params.travel_time * to_seconds(kTick) + 1e-9);
    EXPECT_LT(rig.largest_current, params.stall_current);
  }
}

TEST(ClawController, HoldsWhatItClosesOnWithTheHoldingCurrent) {
  for (const double width : {0.9, 0.4, 0.1}) {
    for (const double noise : {0.0, 0.02}) {
      Rig rig(with_object(width));
      rig.noise = noise;
      rig.told(true, 0.3);
      rig.told(false, 4.0);
      EXPECT_EQ(rig.controller.state(), State::kHolding) << width;
      EXPECT_LE(rig.largest_current, rig.params.current_limit) << width;
      double mean = 0.0;
      for (int k = 0; k < 500; ++k) {
        rig.tick();
        mean += rig.servo.current() / 500.0;
      }
      EXPECT_NEAR(mean, rig.params.holding_current, 0.02) << width;
      EXPECT_NEAR(rig.servo.opening(), width, 1e-9);
      EXPECT_EQ(rig.controller.state(), State::kHolding) << width;
    }
  }
}

TEST(ClawController, SomethingThinIsHeldToo) {
  // It leaves less of the way than makes the servo stall.
  Rig rig(with_object(0.05));
  rig.told(false, 4.0);
  EXPECT_EQ(rig.controller.state(), State::kHolding);
  EXPECT_GT(rig.servo.current(), 0.1);
}

TEST(ClawController, ClosesWhenWhatItHeldSlipsAway) {
  Rig rig(with_object(0.4));
  rig.told(false, 3.0);
  ASSERT_EQ(rig.controller.state(), State::kHolding);
  rig.servo.set_object(false);
  rig.told(false, 3.0);
  EXPECT_EQ(rig.controller.state(), State::kClosed);
}

TEST(ClawController, NobodysSilenceOpensIt) {
  Rig rig(with_object(0.4));
  rig.told(false, 3.0);
  ASSERT_EQ(rig.controller.state(), State::kHolding);
  rig.run(60.0);  // no command at all
  EXPECT_EQ(rig.controller.state(), State::kHolding);
  EXPECT_NEAR(rig.servo.current(), rig.params.holding_current, 0.02);
  rig.connected = false;
  rig.run(5.0);
  EXPECT_EQ(rig.controller.state(), State::kFault);
  EXPECT_NEAR(rig.servo.opening(), 0.4, 1e-9);
  EXPECT_NEAR(rig.servo.current(), rig.params.holding_current, 0.02) << "still held";
}

TEST(ClawController, BlockedWhileOpeningIsAFaultThatDoesNotPushOn) {
  ClawServo::Params servo;
  servo.jammed = true;
  servo.start_opening = 0.3;
  Rig rig(servo);
  rig.told(true, 3.0);
  EXPECT_EQ(rig.controller.state(), State::kFault);
  EXPECT_THAT(rig.controller.reason(), HasSubstr("blocked while opening, at 30 %"));
  EXPECT_LE(rig.largest_current, rig.params.current_limit);
  EXPECT_LT(rig.servo.current(), 0.1) << "it gave way";
  rig.told(true, 30.0);
  EXPECT_EQ(rig.controller.state(), State::kFault) << "the same command is no new one";
  rig.told(false, 2.0);
  EXPECT_EQ(rig.controller.state(), State::kClosed) << "another one is";
  EXPECT_EQ(rig.controller.reason(), "");
}

TEST(ClawController, AServoThatDoesNotMoveIsAFault) {
  ClawController controller{ClawController::Params()};
  Time now{};
  for (int k = 0; k < 150; ++k) {
    now += kTick;
    controller.set_feedback(2000.0, 0.0, now);
    controller.command(true, now);
    (void)controller.tick(now);
  }
  EXPECT_EQ(controller.state(), State::kFault);
  EXPECT_THAT(controller.reason(), HasSubstr("does not open within 1.9 s, stands at 0 %"));
}

TEST(ClawController, AServoThatFallsSilentIsAFaultUntilItIsHeardAgain) {
  Rig rig;
  rig.told(false, 0.3);
  rig.connected = false;
  rig.told(false, 0.16);
  EXPECT_EQ(rig.controller.state(), State::kClosing) << "not yet";
  rig.told(false, 0.1);
  EXPECT_EQ(rig.controller.state(), State::kFault);
  EXPECT_THAT(rig.controller.reason(), HasSubstr("says nothing"));
  EXPECT_FALSE(rig.controller.opening(rig.now));
  const double pulse = *rig.pulse;
  rig.told(false, 5.0);
  EXPECT_EQ(*rig.pulse, pulse) << "stays where it is";
  rig.connected = true;
  rig.told(false, 2.0);
  EXPECT_EQ(rig.controller.state(), State::kClosed);
  EXPECT_EQ(rig.controller.reason(), "");
}

TEST(ClawController, AServoThatWasNeverHeardIsNotMoved) {
  Rig rig;
  rig.connected = false;
  rig.told(true, 1.0);
  EXPECT_FALSE(rig.pulse);
  EXPECT_EQ(rig.controller.state(), State::kFault);
}

TEST(ClawController, WhateverTheServoSaysThePulseStaysInItsRangeAndItsRate) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> position(0.0, 3000.0);
  std::uniform_real_distribution<double> current(-2.0, 2.0);
  ClawController controller{ClawController::Params()};
  Time now{};
  std::optional<double> last;
  controller.set_feedback(1500.0, 0.0, now);
  for (int k = 0; k < 20'000; ++k) {
    now += kTick;
    const bool broken = random() % 10 == 0;
    controller.set_feedback(broken ? std::numeric_limits<double>::quiet_NaN() : position(random),
                            current(random), now);
    if (random() % 50 == 0) controller.command(random() % 2 == 0, now);
    const auto pulse = controller.tick(now);
    if (!pulse) continue;
    ASSERT_GE(*pulse, 1000.0);
    ASSERT_LE(*pulse, 2000.0);
    if (last) {
      ASSERT_LE(std::abs(*pulse - *last), 25.0 + 1e-9);
    }
    last = pulse;
  }
  EXPECT_TRUE(last);
}

TEST(ClawController, RefusesParametersThatCannotBeUsed) {
  const auto refusal = [](const auto& change) -> std::string {
    ClawController::Params params;
    change(params);
    try {
      const ClawController controller(params);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  using P = ClawController::Params;
  EXPECT_EQ(refusal([](P&) {}), "");
  EXPECT_THAT(refusal([](P& p) { p.pulse_open_us = 100.0; }), HasSubstr("400 to 2600"));
  EXPECT_THAT(refusal([](P& p) { p.pulse_open_us = 1950.0; }), HasSubstr("apart"));
  EXPECT_THAT(refusal([](P& p) { p.holding_current = 0.6; }), HasSubstr("'stall_current'"));
  EXPECT_THAT(refusal([](P& p) { p.stall_current = 0.9; }), HasSubstr("'current_limit'"));
  EXPECT_THAT(refusal([](P& p) { p.travel_time = 0.0; }), HasSubstr("positive"));
  EXPECT_THAT(refusal([](P& p) { p.holding_gain_us = -1.0; }), HasSubstr("'holding_gain_us'"));
}

}  // namespace
}  // namespace swiftlet
