// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Two ground stations and one vehicle, and parameters that change while it flies.
#include <csignal>

#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class StationControl : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    start_vehicle(office());
    ASSERT_TRUE(becomes_ready());
  }

  Finished from(const std::string& station, Arguments arguments) {
    arguments.insert(arguments.end(), {"--station", station});
    return gcs(arguments);
  }
  void accepted(const std::string& station, const Arguments& arguments) {
    const Finished finished = from(station, arguments);
    EXPECT_EQ(finished.exit_code, 0) << station << " " << arguments.front() << ": " << finished.err;
  }
  void refused(const std::string& station, const Arguments& arguments, const std::string& holder) {
    const Finished finished = from(station, arguments);
    EXPECT_EQ(finished.exit_code, 1) << station << " " << arguments.front();
    EXPECT_THAT(finished.err, HasSubstr("station '" + holder + "' has control")) << finished.out;
  }
};

TEST_F(StationControl, ASecondStationIsRefusedUntilControlIsHandedOver) {
  Process log = start({"gcs", "log", "--json"});
  EXPECT_EQ(status()["control"], "") << "nobody has commanded yet";
  accepted("base", {"arm", "--wait"});
  EXPECT_EQ(status()["control"], "base");

  const std::string mission = write("hop.yaml", "items:\n  - takeoff: 1\n  - land\n");
  refused("tablet", {"takeoff", "1"}, "base");
  refused("tablet", {"disarm"}, "base");
  refused("tablet", {"goto", "1.5", "1.05", "1.2"}, "base");
  refused("tablet", {"mission", "upload", mission}, "base");
  refused("tablet", {"control", "take"}, "base");
  refused("tablet", {"control", "give", "tablet"}, "base");
  EXPECT_EQ(status()["armed"], true) << "what was refused has changed nothing";
  EXPECT_EQ(status()["uploaded_mission"]["count"], 0);

  accepted("base", {"takeoff", "1", "--wait"});
  // Sticks of the second station are not heard: the vehicle hovers on.
  refused("tablet", {"stick", "--forward", "1", "--for", "1"}, "base");
  EXPECT_EQ(status()["mode"], "Hover");

  environment_["SWIFTLET_STATION"] = "tablet";
  EXPECT_THAT(gcs({"land"}).err, HasSubstr("not 'tablet'")) << "a name from the environment";
  accepted("base", {"hover"});  // the option wins
  environment_.erase("SWIFTLET_STATION");

  accepted("base", {"control", "give", "tabelt"});
  refused("base", {"land"}, "tabelt");
  accepted("base", {"control", "take"});  // nobody has that name

  accepted("base", {"control", "give", "tablet"});
  EXPECT_EQ(status()["control"], "tablet");
  refused("base", {"land"}, "tablet");
  accepted("tablet", {"mission", "upload", mission});
  accepted("tablet", {"control", "release"});
  EXPECT_EQ(status()["control"], "");
  accepted("base", {"land", "--wait"});

  expect_end(log, SIGINT, 0);
  EXPECT_THAT(log.out(), HasSubstr("takeoff refused: station 'base' has control"));
  EXPECT_THAT(log.out(), HasSubstr("control: tablet has it"));
  stop_vehicle();
}

TEST_F(StationControl, AStationThatIsGoneLosesControlAndOneThatIsThereDoesNot) {
  EXPECT_EQ(gcs({"param", "set", "commander", "control_lease", "2"}).exit_code, 0);
  Process base = start({"gcs", "watch", "--station", "base"});
  ASSERT_TRUE(becomes_true(Seconds(10.0), [&] { return !base.out().empty(); }));
  accepted("base", {"arm", "--wait"});
  // It says nothing more, but it is there.
  EXPECT_FALSE(becomes_true(Seconds(4.0), [&] { return status()["control"] != "base"; }));
  refused("tablet", {"disarm"}, "base");
  base.send(SIGKILL);
  ASSERT_TRUE(base.wait(kExitLimit));
  ASSERT_TRUE(status_becomes("without control", Seconds(10.0),
                             [](const json& status) { return status["control"] == ""; }));
  accepted("tablet", {"disarm", "--wait"});
  EXPECT_EQ(status()["control"], "tablet");
  stop_vehicle();
}

TEST_F(StationControl, ParametersChangeOnTheGroundAndSomeOfThemInFlight) {
  const auto set = [this](const char* component, const char* name, const char* value) {
    return gcs({"param", "set", component, name, value});
  };
  EXPECT_EQ(set("commander", "takeoff_speed", "0.5").exit_code, 0) << "before lift-off";
  EXPECT_EQ(set("commander", "control_lease", "1").exit_code, 0);
  accepted("base", {"arm", "--wait"});
  accepted("base", {"takeoff", "1", "--wait"});
  const Finished late = set("commander", "takeoff_speed", "0.6");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_THAT(late.err, HasSubstr("before lift-off, not in flight"));
  const Finished never = set("planner", "radius", "0.3");
  EXPECT_EQ(never.exit_code, 1);
  EXPECT_THAT(never.err, HasSubstr("when the component starts"));

  EXPECT_EQ(set("planner", "max_speed", "0.4").exit_code, 0);
  Process go_to = start({"gcs", "goto", "3.0", "1.05", "--wait", "--station", "base"});
  double fastest = 0.0;
  ASSERT_TRUE(status_becomes("there", Seconds(30.0), [&](const json& status) {
    fastest = std::max(fastest, status["speed_m_s"].get<double>());
    if (status["mode"] == "Indoor Navigation") {
      EXPECT_EQ(status["control"], "base") << "who waits keeps control";
    }
    return fastest > 0.2 && status["mode"] == "Hover";
  }));
  EXPECT_EQ(go_to.wait(kExitLimit)->exit_code, 0);
  EXPECT_LT(fastest, 0.55) << "it was 1.5 m/s";

  EXPECT_EQ(set("commander", "fence_radius", "3").exit_code, 0);
  const Finished outside = from("base", {"goto", "5.0", "1.05"});
  EXPECT_EQ(outside.exit_code, 1);
  EXPECT_THAT(outside.err, HasSubstr("fence")) << "as it is now";
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
