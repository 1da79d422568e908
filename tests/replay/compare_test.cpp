// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A recorded flight, run again: the same outputs, or the first that is not, and what would have
// been if something had gone wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "components/runtime/message.hpp"
#include "swiftlet_msgs.h"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;
using swiftlet_msgs::msg::MotorCommand;
using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

constexpr double kMotorPeriod = 0.004;  // [s]

class Compare : public test::SystemTest {
 protected:
  void SetUp() override {
    flight_ = path("flight.mcap");
    // The long form is about the flight that everything is measured with.
    const std::string scenario = test::full_tests() ? test::office() : test::hop();
    const test::Finished flown = run({"fly", scenario, "--record", flight_});
    ASSERT_EQ(flown.exit_code, 0) << flown.err;
  }

  /// What `replay --compare --json` says, and with which exit code.
  struct Outcome {
    int exit_code = 0;
    json result;
    double first_time() const { return result["first"]["time_s"].get<double>(); }
    std::string first_topic() const { return result["first"]["topic"].get<std::string>(); }
  };
  Outcome compare(const Arguments& more = {}) {
    Arguments arguments{"--log", "error", "replay", flight_, "--compare", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::Finished done = run(arguments);
    EXPECT_THAT(done.out, HasSubstr("{")) << done.err;
    return {done.exit_code, json::parse(done.out, nullptr, false)};
  }

  std::vector<mcap::Sample> recorded(const std::string& topic) const {
    mcap::Filter filter;
    filter.topics = {topic};
    return mcap::read_samples(mcap::Reader::open(flight_).value(), filter);
  }
  std::size_t count_after(const std::string& topic, double time) const {
    const auto samples = recorded(topic);
    return static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [time](const mcap::Sample& sample) {
          return static_cast<double>(sample.log_time) * 1e-9 > time;
        }));
  }

  std::string flight_;
};

TEST_F(Compare, AFlightIsIdenticalEachTime) {
  std::set<std::string> hashes;
  const int runs = test::full_tests() ? 10 : 3;
  for (int i = 0; i < runs; ++i) {
    const Outcome outcome = compare();
    ASSERT_EQ(outcome.exit_code, 0) << outcome.result;
    EXPECT_EQ(outcome.result["different"], 0);
    EXPECT_TRUE(outcome.result["first"].is_null());
    EXPECT_GT(outcome.result["compared"], 10'000);
    hashes.insert(outcome.result["hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 1U);
}

TEST_F(Compare, EachComponentAloneIsIdentical) {
  for (const char* component :
       {"estimator", "flight_controller", "lidar_mapper", "planner", "guard", "commander"}) {
    const Outcome outcome = compare({"--into", component});
    EXPECT_EQ(outcome.exit_code, 0) << component << ": " << outcome.result;
    EXPECT_GT(outcome.result["compared"], 100) << component;
  }
}

TEST_F(Compare, AChangedGainIsReportedAtItsFirstEffect) {
  // Gains act from the first command that turns the rotors on.
  std::optional<double> first_thrust;
  for (const mcap::Sample& sample : recorded("motors")) {
    if (from_cdr<MotorCommand>(sample.data).value().armed()) {
      first_thrust = static_cast<double>(sample.log_time) * 1e-9;
      break;
    }
  }
  ASSERT_TRUE(first_thrust);
  const Outcome outcome = compare(
      {"--into", "flight_controller", "--param", "flight_controller.rate_gain=[21, 21, 9]"});
  EXPECT_EQ(outcome.exit_code, 1);
  ASSERT_FALSE(outcome.result["first"].is_null());
  EXPECT_EQ(outcome.first_topic(), "motors");
  EXPECT_THAT(outcome.result["first"]["field"].get<std::string>(), HasSubstr("thrust["));
  EXPECT_NEAR(outcome.first_time(), *first_thrust, 1e-6);
  EXPECT_EQ(outcome.result["different_by_topic"].size(), 1U) << outcome.result;
}

TEST_F(Compare, AKilledComponentSaysNothingAnyMoreAndOthersNoticeAtOnce) {
  const double kill = 13.0;  // in the air
  const Outcome outcome = compare({"--what-if", "kill estimator@13"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.first_time(), AllOf(Ge(kill), Le(kill + 0.03)));
  EXPECT_NEAR(outcome.result["different_by_topic"]["odometry"].get<double>(),
              static_cast<double>(count_after("odometry", kill)), 1.0);
  EXPECT_GT(outcome.result["different_by_topic"]["motors"], 0) << "the others fly something else";
}

TEST_F(Compare, AnInputThatComesLateIsSeenInWhatItLeadsTo) {
  const Outcome outcome =
      compare({"--into", "lidar_mapper", "--what-if", "delay scan 150ms @3..4"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.first_topic(), "map");
  // Ten scans and five maps a second: the first map lacks its newest scan.
  EXPECT_THAT(outcome.first_time(), AllOf(Ge(3.0), Le(3.5)));
}

TEST_F(Compare, WhatIsLostAtRandomIsTheSameEachTime) {
  const Arguments what_if{"--what-if", "drop imu0 20% @3..5"};
  const Outcome first = compare(what_if);
  const Outcome second = compare(what_if);
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_THAT(first.first_time(), AllOf(Ge(3.0), Le(3.0 + 20 * kMotorPeriod)));
  EXPECT_EQ(first.result, second.result);
}

TEST_F(Compare, WhatCannotBeReplayedIsSaid) {
  const test::Finished unknown = run({"replay", flight_, "--what-if", "kill estimater@6"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("'estimator'"));
  const test::Finished malformed = run({"replay", flight_, "--what-if", "kill estimator"});
  EXPECT_EQ(malformed.exit_code, 2);
  EXPECT_THAT(malformed.err, HasSubstr("kill estimator@12.5"));
  const test::Finished component = run({"replay", flight_, "--into", "planer"});
  EXPECT_EQ(component.exit_code, 2);
  EXPECT_THAT(component.err, HasSubstr("'planner'"));
}

TEST_F(Compare, AFlightInWhichSomethingGoesWrongIsFlownAgainBitForBit) {
  const auto fly = [&](const std::string& name) {
    const std::string file = path(name);
    const test::Finished flown = run({"fly", test::hop(), "--what-if", "kill planner@13",
                                      "--what-if", "drop scan 30%", "--record", file});
    EXPECT_EQ(flown.exit_code, 1);
    EXPECT_THAT(flown.out + flown.err, HasSubstr("planner fell silent"));
    const auto hash = flown.out.find("hash ");
    EXPECT_NE(hash, std::string::npos) << flown.out;
    flight_ = file;
    EXPECT_LT(recorded("scan").size(), 0.8 * 10.0 * 60.0) << "some are lost";
    return flown.out.substr(hash, 21);
  };
  EXPECT_EQ(fly("first.mcap"), fly("second.mcap"));
}

}  // namespace
}  // namespace swiftlet
