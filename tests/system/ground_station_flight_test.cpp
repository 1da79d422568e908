// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class GroundStationFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 10) GTEST_SKIP() << "the thread sanitizer is too slow to fly in real time";
    start_vehicle(office());
  }
};

TEST_F(GroundStationFlight, FourProcessesFlyByCommandsAlone) {
  if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  ASSERT_TRUE(becomes_ready());
  json now = status();
  ASSERT_TRUE(now.contains("position_m"));
  EXPECT_EQ(now["mode"], "Grounded");
  EXPECT_EQ(now["armed"], false);
  EXPECT_LT(distance(now, 0.9, 1.05), 0.3);  // where office.yaml puts it

  const Finished too_early = gcs({"takeoff", "1.2"});
  EXPECT_EQ(too_early.exit_code, 1);
  EXPECT_THAT(too_early.err, HasSubstr("not armed"));

  command({"arm"});
  command({"takeoff", "1.2"});
  ends_in("Takeoff", "Hover", Seconds(20.0));
  EXPECT_NEAR(status()["height_m"].get<double>(), 1.2, 0.25);

  command({"goto", "2.2", "4.4"});
  ends_in("Indoor Navigation", "Hover", Seconds(40.0));
  now = status();
  EXPECT_EQ(now["mission"]["done"], true) << now.dump(2);
  EXPECT_LT(distance(now, 2.2, 4.4), 0.3);

  command({"hover"});
  EXPECT_EQ(status()["mode"], "Hover");
  command({"land"});
  ends_in("Land", "Grounded", Seconds(20.0));
  ASSERT_TRUE(status_becomes("disarmed", Seconds(5.0),
                             [](const json& status) { return status["armed"] == false; }));
  EXPECT_LT(status()["height_m"].get<double>(), 0.25);
  stop_vehicle();
}

TEST_F(GroundStationFlight, AHostThatWasKilledServesAgainAtOnce) {
  ASSERT_TRUE(becomes_ready());

  kill_and_start_again(3);  // commander
  ASSERT_TRUE(becomes_ready());
  command({"arm"});
  command({"disarm"});

  kill_and_start_again(1);  // estimator and flight controller
  // The old one is dead, so what is heard is the new one.
  ASSERT_TRUE(status_becomes("with a position", Seconds(10.0),
                             [](const json& status) { return status.contains("position_m"); }));
  ASSERT_TRUE(becomes_ready());
  command({"arm"});
  command({"disarm"});
  stop_vehicle();
}

TEST_F(GroundStationFlight, WithoutAnEstimateArmingIsRefusedWithTheReason) {
  ASSERT_TRUE(becomes_ready());
  expect_end(processes_[1], SIGTERM, 0);
  ASSERT_TRUE(status_becomes("not ready", Seconds(10.0),
                             [](const json& status) { return status["ready"] == false; }));
  const Finished refused = gcs({"arm"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("odometry"));
}

class RealTimeFlight : public SystemTest {};

TEST_F(RealTimeFlight, CompletesTheMissionAsFastAsTimePasses) {
  if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  const Finished flown = run({"fly", hop(), "--real-time", "--report", path("report")});
  EXPECT_EQ(flown.exit_code, 0) << flown.out << flown.err;
  const json report = read_report(folder() / "report");
  ASSERT_FALSE(report.is_null());
  EXPECT_EQ(report["success"], true);
  EXPECT_EQ(report["contacts"], 0);
  EXPECT_GE(flown.duration.count(), report["flight_time_s"].get<double>());
}

}  // namespace
}  // namespace swiftlet::test
