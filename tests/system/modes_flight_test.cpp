// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Every mode, flown by the commands of a ground station alone, each component in a real process.
#include <algorithm>
#include <cmath>

#include "estimation/geodesy/local_origin.hpp"
#include "tests/slowdown.hpp"
#include "tests/system/flight_observer.hpp"
#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ModesFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    start_vehicle(SWIFTLET_SOURCE_DIR "/components/sim/scenarios/courtyard.yaml");
    hosts_.push_back({"run", "explorer"});
    hosts_.push_back({"run", "guard"});
    for (std::size_t i = processes_.size(); i < hosts_.size(); ++i) {
      processes_.push_back(start(hosts_[i]));
    }
  }

  void stick(const Arguments& arguments) {
    Arguments all{"stick"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Arguments command{"gcs"};
    command.insert(command.end(), all.begin(), all.end());
    const Finished finished = run(command, Seconds(20.0));
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
  }
  void gps_to(const Eigen::Vector3d& place) {
    const GlobalPosition there = LocalOrigin({47.397742, 8.545594, 488.0}).to_global(place);
    command({"gps", std::to_string(there.latitude), std::to_string(there.longitude), "--altitude",
             std::to_string(place.z())});
  }
};

TEST_F(ModesFlight, AllEightByCommandsAlone) {
  ASSERT_TRUE(becomes_ready());
  FlightObserver observer(domain());
  command({"arm"});
  command({"takeoff", "1.2"});
  ends_in("Takeoff", "Hover", Seconds(20.0));

  command({"goto", "8.5", "6.5"});
  ends_in("Indoor Navigation", "Hover", Seconds(40.0));
  EXPECT_LT(distance(status(), 8.5, 6.5), 0.3);

  command({"explore"});
  ends_in("Indoor Exploration", "Hover", Seconds(120.0));
  EXPECT_LT(distance(status(), 3.0, 4.0), 0.4) << "it comes back";
  EXPECT_EQ(status()["mission"]["done"], true);

  const Finished nobody = gcs({"manual"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_THAT(nobody.err, HasSubstr("remote control"));
  stick({"--left", "-0.7", "--for", "1.5"});  // it takes over by itself
  json now = status();
  EXPECT_LT(now["position_m"][1].get<double>(), 3.6);
  ends_in("Manual", "Hover", Seconds(5.0));  // the remote control is gone
  EXPECT_THAT(status()["reason"].get<std::string>(), HasSubstr("remote control has been silent"));

  stick({"--forward", "-1", "--assisted", "--for", "7"});
  now = status();
  EXPECT_NEAR(now["position_m"][0].get<double>(), 0.555, 0.15) << "as the vehicle knows it";
  EXPECT_NEAR(observer.seen().position.x(), 0.555, 0.05) << "as it is";
  ends_in("Assisted Manual", "Hover", Seconds(5.0));

  gps_to({3.0, 11.0, 3.5});  // over the wall
  ends_in("GPS Guidance", "Hover", Seconds(40.0));
  EXPECT_LT(distance(status(), 3.0, 11.0), 0.8);
  gps_to({0.0, 0.0, 3.5});
  command({"return"});
  EXPECT_EQ(status()["mode"], "GPS Guidance");
  ends_in("GPS Guidance", "Land", Seconds(40.0));
  ends_in("Land", "Grounded", Seconds(40.0));
  const FlightObserver::Seen seen = observer.seen();
  EXPECT_EQ(seen.contacts, 0u) << seen.last_contact;
  EXPECT_LT((seen.position.head<2>() - Eigen::Vector2d(3.0, 4.0)).norm(), 0.3);
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
