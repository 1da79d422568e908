// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The claw and the simulated servo on real Fast DDS in lockstep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
namespace state = swiftlet_msgs::msg::ClawState_Constants;

/// A claw, its servo in a scenario, and a commander who says what it shall be.
class ClawBench : public testing::Test {
 protected:
  void start(const std::string& claw_in_scenario, const std::string& parameters = "") {
    bench_.emplace("claw", parameters);
    scenario_ =
        std::filesystem::temp_directory_path() / ("claw-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(scenario_) << "name: claw\nworld: " << SWIFTLET_SOURCE_DIR
                             << "/components/sim/worlds/office.sdf\nclaw: " << claw_in_scenario
                             << "\n";
    sim_ = &bench_->host.add("sim_claw",
                             Config::parse("scenario: " + scenario_.string(), "test.yaml"));
    states_ = &bench_->record(topic::claw_state);
    pulses_ = &bench_->record(topic::claw_servo);
    feedback_ = &bench_->record(topic::claw_feedback);
    bench_->every(
        topic::claw_command, 200ms, Time(1s),
        [this](Time) {
          swiftlet_msgs::msg::ClawCommand command;
          command.open(open_);
          return command;
        },
        command_until_);
  }
  ~ClawBench() override { std::filesystem::remove(scenario_); }

  const swiftlet_msgs::msg::ClawState& at(Time time) const {
    const auto after = std::find_if(states_->begin(), states_->end(), [&](const auto& message) {
      return from_msg(message.header().stamp()) >= time;
    });
    return after == states_->end() ? states_->back() : *after;
  }
  float largest_current() const {
    float largest = 0.0f;
    for (const auto& message : *feedback_) largest = std::max(largest, message.current());
    return largest;
  }

  bool open_ = false;
  Time command_until_ = Time::max();
  std::optional<Bench> bench_;
  std::filesystem::path scenario_;
  Component* sim_ = nullptr;
  std::vector<swiftlet_msgs::msg::ClawState>* states_ = nullptr;
  std::vector<swiftlet_msgs::msg::ServoCommand>* pulses_ = nullptr;
  std::vector<swiftlet_msgs::msg::ServoFeedback>* feedback_ = nullptr;
};

TEST_F(ClawBench, ClosesOnNothingAndOpensAgain) {
  start("{}");
  bench_->probe.call_at(Time(4s), [this](Time) { open_ = true; });
  bench_->run_until(Time(7s));
  EXPECT_EQ(at(Time(800ms)).state(), state::UNKNOWN);
  EXPECT_EQ(at(Time(1500ms)).state(), state::CLOSING);
  EXPECT_EQ(at(Time(3s)).state(), state::CLOSED);
  EXPECT_NEAR(at(Time(3s)).opening(), 0.0f, 0.03f);
  EXPECT_EQ(at(Time(4500ms)).state(), state::OPENING);
  EXPECT_EQ(states_->back().state(), state::OPEN);
  EXPECT_NEAR(states_->back().opening(), 1.0f, 0.03f);
  EXPECT_NEAR(static_cast<double>(pulses_->size()), 6.0 * 50.0, 5.0)
      << "50 Hz from the first command";
  EXPECT_GE(from_msg(pulses_->front().stamp()), Time(1s)) << "and none before";
  EXPECT_GE(states_->size(), 70u) << "10 Hz";
}

TEST_F(ClawBench, HoldsAnObjectWithinTheCurrentLimitAlsoWithoutACommander) {
  command_until_ = Time(4s);
  start("{object: true}", "current_limit: 0.7\nholding_current: 0.25\n");
  bench_->run_until(Time(20s));
  EXPECT_EQ(at(Time(3s)).state(), state::HOLDING);
  EXPECT_EQ(states_->back().state(), state::HOLDING);
  EXPECT_NEAR(states_->back().opening(), 0.4f, 1e-3f);
  EXPECT_NEAR(states_->back().current(), 0.25f, 0.02f);
  EXPECT_GT(largest_current(), 0.5f) << "it did push";
  EXPECT_LE(largest_current(), 0.7f);
}

TEST_F(ClawBench, AServoThatDiesIsAFaultAndThePulseStays) {
  start("{object: true}");
  bench_->probe.call_at(Time(4s), [this](Time) { sim_->halt(); });
  bench_->run_until(Time(8s));
  EXPECT_EQ(at(Time(3900ms)).state(), state::HOLDING);
  EXPECT_EQ(at(Time(4500ms)).state(), state::FAULT);
  EXPECT_THAT(at(Time(4500ms)).reason(), HasSubstr("says nothing"));
  EXPECT_TRUE(std::isnan(states_->back().opening()));
  const auto first_after = std::find_if(pulses_->begin(), pulses_->end(), [](const auto& pulse) {
    return from_msg(pulse.stamp()) >= Time(4300ms);
  });
  ASSERT_NE(first_after, pulses_->end());
  for (auto pulse = first_after; pulse != pulses_->end(); ++pulse) {
    EXPECT_EQ(pulse->pulse_us(), first_after->pulse_us());
  }
}

TEST_F(ClawBench, JawsThatAreBlockedWhileOpeningAreAFault) {
  open_ = true;
  start("{jammed: true, start_opening: 0.3}");
  bench_->run_until(Time(5s));
  EXPECT_EQ(states_->back().state(), state::FAULT);
  EXPECT_THAT(states_->back().reason(), HasSubstr("blocked while opening, at 30 %"));
  EXPECT_LE(largest_current(), 0.8f);
}

TEST(ClawParameters, AreRefusedWithFileAndRemedy) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      Bench bench("claw", yaml);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("pulse_open_us: 1100"), "");
  EXPECT_THAT(refusal("pulse_open_us: 100"), HasSubstr("400 to 2600"));
  EXPECT_THAT(refusal("holding_current: 2"), HasSubstr("'stall_current'"));
  EXPECT_THAT(refusal("travel_time: 0"), HasSubstr("'travel_time'"));
}

}  // namespace
}  // namespace swiftlet::test
