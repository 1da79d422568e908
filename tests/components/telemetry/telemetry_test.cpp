// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The component on real Fast DDS in lockstep.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
namespace flag = swiftlet_msgs::msg::Telemetry_Constants;

TEST(Telemetry, ComesFiveTimesASecondAndForgetsWhatIsNoLongerHeard) {
  Bench bench("telemetry");
  const auto& heard = bench.record(topic::telemetry);
  bench.send_odometry({1.0, 2.0, 3.0}, Time(2s));
  bench.every(
      topic::vehicle_status, 100ms, Time{},
      [](Time) {
        swiftlet_msgs::msg::VehicleStatus status;
        status.ready(true);
        status.height(0.5);
        status.reason("ready");
        return status;
      },
      Time(4s));
  bench.every(topic::battery, 1s, Time{}, [](Time now) {
    sensor_msgs::msg::BatteryState battery;
    battery.percentage(static_cast<float>(1.0 - to_seconds(now) / 600.0));
    battery.voltage(16.0f);
    return battery;
  });
  bench.run_until(Time(60s));
  ASSERT_NEAR(static_cast<double>(heard.size()), 300.0, 2.0);
  for (const auto& message : heard) {
    const double t = to_seconds(from_msg(message.stamp()));
    // In between, what was heard last is not old yet.
    const bool has_position = t > 0.1 && t <= 2.0;
    if (t > 0.1 && (t <= 2.0 || t > 2.03)) {
      EXPECT_EQ((message.flags() & flag::POSITION_KNOWN) != 0, has_position) << t;
      EXPECT_EQ(std::isnan(message.position()[0]), !has_position) << t;
    }
    if (t > 0.3 && (t <= 4.0 || t > 4.3)) {
      EXPECT_EQ((message.flags() & flag::READY) != 0, t <= 4.0) << t;
      EXPECT_EQ(message.reason(), t <= 4.0 ? "ready" : "no vehicle/status is heard") << t;
    }
    if (t > 1.1) {
      EXPECT_NE(message.flags() & flag::BATTERY_KNOWN, 0) << t;
    }
    if (t > 35.0) {
      EXPECT_NEAR(message.time_left(), 600.0 - t, 2.0) << t;
    }
  }
}

}  // namespace
}  // namespace swiftlet::test
