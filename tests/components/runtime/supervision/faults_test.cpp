// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "all_messages.hpp"
#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using rosgraph_msgs::msg::Clock;
using ::testing::HasSubstr;

TEST(ParseFault, ReadsTheThreeKinds) {
  const Fault kill = parse_fault("kill estimator@12.5");
  EXPECT_EQ(kill.kind, Fault::Kind::kKill);
  EXPECT_EQ(kill.target, "estimator");
  EXPECT_EQ(kill.begin, 12500ms);

  const Fault delay = parse_fault("delay phone/pose 80ms");
  EXPECT_EQ(delay.kind, Fault::Kind::kDelay);
  EXPECT_EQ(delay.target, "phone/pose");
  EXPECT_EQ(delay.delay, 80ms);
  EXPECT_EQ(delay.begin, 0s);
  EXPECT_EQ(delay.end, Duration::max());

  const Fault drop = parse_fault("  drop imu0 20 % @3..4.5 ");
  EXPECT_EQ(drop.kind, Fault::Kind::kDrop);
  EXPECT_DOUBLE_EQ(drop.probability, 0.2);
  EXPECT_EQ(drop.begin, 3s);
  EXPECT_EQ(drop.end, 4500ms);
}

TEST(ParseFault, RefusesWhatItCannotRead) {
  for (const char* text :
       {"", "kill", "kill estimator", "kill estimator@", "kill estimator@soon", "delay scan",
        "delay scan 80", "delay scan -80ms", "drop imu0", "drop imu0 120%", "drop imu0 20% @5..4",
        "stop estimator@3", "kill estimator@99999999999999999999"}) {
    EXPECT_THROW(parse_fault(text), ConfigError) << text;
  }
  try {
    parse_fault("stop it");
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("delay scan 80ms")) << "says how it is written";
  }
}

constexpr Topic<Clock> kTick{"tick", qos::command};

/// Publishes its time every 10 ms for a second.
struct Ticker : Component {
  explicit Ticker(const ComponentContext& context) : Component(context) {
    tick_ = advertise(kTick);
    every(10ms, [this](Time now) {
      Clock message;
      message.clock().nanosec(static_cast<std::uint32_t>(now.time_since_epoch().count()));
      tick_.publish(message);
    });
  }
  Publisher<Clock> tick_;
};

struct Heard {
  Time sent;
  Time heard;
};

struct Listener : Component {
  Listener(const ComponentContext& context, std::vector<Heard>& all) : Component(context) {
    subscribe(kTick, [this, &all](const Clock& tick) {
      all.push_back({Time(std::chrono::nanoseconds(tick.clock().nanosec())), now()});
    });
    call_at(Time(995ms), [this](Time) { stop(0); });
  }
};

std::vector<Heard> run_with(const std::vector<std::string>& faults) {
  HostOptions options;
  options.lockstep = true;
  for (const std::string& fault : faults) options.faults.push_back(parse_fault(fault));
  options.fault_seed = 3;
  std::vector<Heard> all;
  Host host(options);
  host.emplace<Ticker>("ticker");
  host.emplace<Listener>("listener", all);
  EXPECT_EQ(host.run(), 0);
  return all;
}

TEST(Faults, NothingGoesWrongWithoutThem) {
  const auto heard = run_with({});
  ASSERT_EQ(heard.size(), 99u);
  for (const Heard& each : heard) EXPECT_EQ(each.sent, each.heard);
}

TEST(Faults, AKilledComponentFallsSilent) {
  const auto heard = run_with({"kill ticker@0.505"});
  ASSERT_EQ(heard.size(), 50u);
  EXPECT_EQ(heard.back().sent, Time(500ms));
}

TEST(Faults, ADelayedTopicComesLaterInTheSameOrder) {
  const auto heard = run_with({"delay tick 80ms @0.3..0.6"});
  ASSERT_EQ(heard.size(), 99u) << "nothing is lost";
  for (const Heard& each : heard) {
    const bool late = each.sent >= Time(300ms) && each.sent < Time(600ms);
    EXPECT_EQ(each.heard - each.sent, late ? 80ms : 0ms) << to_seconds(each.sent);
  }
}

TEST(Faults, DropsTheShareThatIsAskedForTheSameEachTime) {
  const auto heard = run_with({"drop tick 40%"});
  EXPECT_GT(heard.size(), 45u);
  EXPECT_LT(heard.size(), 75u);
  const auto again = run_with({"drop tick 40%"});
  ASSERT_EQ(again.size(), heard.size());
  for (std::size_t i = 0; i < heard.size(); ++i) EXPECT_EQ(again[i].sent, heard[i].sent);
  EXPECT_TRUE(run_with({"drop tick 100%"}).empty());
}

TEST(Faults, TargetsThatTheRunDoesNotHaveAreRefused) {
  const auto message = [](const std::string& fault) -> std::string {
    try {
      run_with({fault});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("kill tickr@1"), HasSubstr("did you mean 'ticker'?"));
  EXPECT_THAT(message("drop tik 5%"), HasSubstr("did you mean 'tick'?"));
}

}  // namespace
}  // namespace swiftlet
