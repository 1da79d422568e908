// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// A mission in a file, flown by the verbs of the ground station alone, in real processes.
#include <fstream>
#include <sstream>

#include "tests/slowdown.hpp"
#include "tests/system/flight_observer.hpp"
#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;

constexpr const char* kMission = R"(mission: {name: courtyard}
items:
  - takeoff: 1.2
  - goto: {x: 4.5, y: 4, z: 1.2}
  - goto: {x: 4.5, y: 6.5, z: 1.2, hold: 1}
  - gps: {latitude: 47.397742, longitude: 8.545594, altitude: 3.5}
  - return
)";

std::string content_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class MissionFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    start_vehicle(SWIFTLET_SOURCE_DIR "/components/sim/scenarios/courtyard.yaml");
  }
  /// Runs `gcs <arguments>`, which must say `words`.
  void says(const std::string& words, const Arguments& arguments) {
    const Finished finished = gcs(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr(words));
  }
  nlohmann::json mission_status() {
    const Finished finished = gcs({"mission", "status", "--json"});
    return finished.exit_code == 0 ? nlohmann::json::parse(finished.out) : nlohmann::json();
  }
};

TEST_F(MissionFlight, UploadedStartedPausedGoneOnWithAndReadBack) {
  const std::string file = write("courtyard.yaml", kMission);
  ASSERT_TRUE(becomes_ready());
  FlightObserver observer(domain());

  const Finished none = gcs({"mission", "start"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("there is none; upload one first"));

  const Finished upload = gcs({"mission", "upload", file});
  ASSERT_EQ(upload.exit_code, 0) << upload.err;
  EXPECT_THAT(upload.out, HasSubstr("upload: 5 items, read back"));
  const Finished download = gcs({"mission", "download", path("back.yaml")});
  ASSERT_EQ(download.exit_code, 0) << download.err;
  const std::string back = content_of(path("back.yaml"));
  EXPECT_EQ(back.substr(back.find("items:")),
            std::string(kMission).substr(std::string(kMission).find("items:")));

  EXPECT_THAT(gcs({"mission", "start"}).err, HasSubstr("not armed"));
  says("arm: armed", {"arm", "--wait"});
  says("accepted", {"mission", "start"});
  ASSERT_TRUE(becomes_true(Seconds(40.0), [&] {
    const auto mission = mission_status();
    return !mission.is_null() && mission["item"] == 3;
  }));
  says("paused", {"mission", "pause", "--wait"});
  EXPECT_EQ(status()["mode"], "Hover");
  EXPECT_EQ(mission_status()["state"], "paused");
  EXPECT_EQ(status()["uploaded_mission"]["state"], "paused");
  says("mission   paused, 5 items, at item 3: pause requested", {"status"});

  // To its end, with an exit code that a script can use.
  const Finished flown = run({"gcs", "mission", "start", "--wait", "--json"}, Seconds(120.0));
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  const auto told = nlohmann::json::parse(flown.out);
  EXPECT_EQ(told["done"], true);
  EXPECT_THAT(told["text"].get<std::string>(), HasSubstr("all 5 items done"));
  EXPECT_EQ(status()["mode"], "Grounded");
  const FlightObserver::Seen seen = observer.seen();
  EXPECT_EQ(seen.contacts, 0u) << seen.last_contact;
  EXPECT_LT((seen.position.head<2>() - Eigen::Vector2d(3.0, 4.0)).norm(), 0.3);
  says("accepted", {"mission", "clear"});
  EXPECT_EQ(mission_status()["state"], "none");
  stop_vehicle();
}

/// A take-off that is waited for, and one that comes to another end.
TEST_F(MissionFlight, WaitingSaysHowItEnded) {
  ASSERT_TRUE(becomes_ready());
  command({"arm"});
  const Finished up = run({"gcs", "takeoff", "1.2", "--wait"}, Seconds(30.0));
  EXPECT_EQ(up.exit_code, 0) << up.err;
  EXPECT_THAT(up.out, HasSubstr("takeoff: hovers at 1."));
  const Finished away = run({"gcs", "goto", "40", "40", "--wait"}, Seconds(40.0));
  EXPECT_EQ(away.exit_code, 1);
  EXPECT_THAT(away.err, HasSubstr("goto: Hover: "));
  const Finished down = run({"gcs", "land", "--wait"}, Seconds(40.0));
  EXPECT_EQ(down.exit_code, 0) << down.err;
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
