// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The guard with real messages: how fast it takes over in real time, and that it does in a flight
// whose commander has gone mad.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "mode_flight.hpp"
#include "tests/components/component_bench.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Setpoint = swiftlet_msgs::msg::Setpoint;
namespace kind = swiftlet_msgs::msg::Setpoint_Constants;
namespace code = swiftlet_msgs::msg::ModeCommand_Constants;

Setpoint setpoint_at(Time now, const Eigen::Vector3d& position) {
  FlatReference reference;
  reference.position = position;
  Setpoint setpoint;
  setpoint.header(make_header(now, frame::kMap));
  setpoint.kind(kind::TRACK);
  set_reference(reference, setpoint);
  return setpoint;
}

TEST(GuardLive, TakesOverWithinTwentyMilliseconds) {
  HostOptions options;
  options.participant.domain = 75;
  Host host(options);
  host.add("guard");
  auto& probe = host.emplace<Probe>("probe");
  auto odometry = probe.advertise(topic::odometry);
  auto setpoint = probe.advertise(topic::setpoint);
  std::optional<Time> wrong_since;
  std::vector<double> delays;
  bool acting = false;
  int calm = 0;
  probe.subscribe(topic::guard_setpoint, [&](const Setpoint&) {
    if (wrong_since) delays.push_back(1e3 * to_seconds(probe.now() - *wrong_since));
    wrong_since.reset();
  });
  probe.subscribe(topic::guard_status,
                  [&](const swiftlet_msgs::msg::GuardStatus& status) { acting = status.acting(); });
  probe.every(10ms, [&](Time now) {
    odometry.publish(to_odometry(now, RigidBodyState{}));
    // A second of sense, then one setpoint that has none.
    const bool wrong = !acting && ++calm % 50 == 0;
    if (wrong) wrong_since = now;
    setpoint.publish(
        setpoint_at(now, wrong ? Eigen::Vector3d(5.0, 0.0, 0.0) : Eigen::Vector3d::Zero()));
    if (delays.size() == 20) probe.stop(0);
  });
  probe.call_at(probe.now() + 60s * kSlowdown, [&](Time) { probe.stop(1); });
  ASSERT_EQ(host.run(), 0) << delays.size() << " takeovers";
  std::sort(delays.begin(), delays.end());
  std::printf("takes over after %.2f ms (median), %.2f ms (worst of 20)\n", delays[10],
              delays.back());
  EXPECT_LT(delays[10], 20.0 * kSlowdown);
}

/// The commander is gone, and somebody else sends what one would send who has gone mad.
TEST(GuardFlight, ACommanderThatGoesMadIsStopped) {
  for (const Eigen::Vector3d& leap :
       {Eigen::Vector3d(4.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 8.0)}) {
    ModeFlight flight;
    ScriptedPilot& pilot = flight.pilot();
    auto setpoint = pilot.advertise(topic::setpoint);
    bool is_mad = false;
    Eigen::Vector3d place;
    double farthest = 0.0;
    pilot.every(10ms, [&](Time now) {
      if (is_mad) setpoint.publish(setpoint_at(now, place + leap));
    });
    flight.take_off();
    flight.wait(1.0);
    flight.check([&] {
      place = pilot.truth;
      flight.kill("commander");
      is_mad = true;
    });
    flight.add({"madness",
                [] {},
                [&] {
                  farthest = std::max(farthest, (pilot.truth - place).norm());
                  return pilot.step_s > 3.0;
                },
                5.0,
                {}});
    flight.check([&] {
      EXPECT_TRUE(pilot.guard_acting);
      EXPECT_THAT(pilot.guard_reason, HasSubstr("m away"));
      EXPECT_LT(farthest, 0.25);
      is_mad = false;
    });
    // Nobody commands any more: it lands by itself.
    flight.add({"down", [] {}, [&] { return pilot.on_ground; }, 30.0, {}});
    flight.fly();
  }
}

TEST(GuardFlight, WhoFliesByHandAtAWallIsStoppedAtItAndMayGoAway) {
  ModeFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  flight.take_off();
  flight.order(code::MANUAL, "Manual");
  flight.hold({-1.0, 0.0, 0.0, 0.0, false}, 8.0);  // the wall is at x = 0, and the hull 0.25 m
  flight.check([&] {
    EXPECT_THAT(pilot.guard_reason, HasSubstr("m to what the LIDAR sees"));
    EXPECT_GT(pilot.truth.x(), 0.25);
    EXPECT_LT(pilot.truth.x(), 0.45);
  });
  flight.wait(2.0);
  flight.hold({1.0, 0.0, 0.0, 0.0, false}, 2.0);
  flight.check([&] { EXPECT_GT(pilot.truth.x(), 1.0); });
  flight.wait(1.0);
  flight.land();
  flight.fly();
  EXPECT_GT(pilot.clearance, 0.0);
}

}  // namespace
}  // namespace swiftlet::test
