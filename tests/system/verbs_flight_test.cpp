// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// The ground station's verbs against a vehicle in real processes: what they write, and that what
// they change is changed.
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>

#include "perception/map_io.hpp"
#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class VerbsFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    start_vehicle(office());
    ASSERT_TRUE(becomes_ready());
  }
  /// What `gcs <arguments>` says, which must be done with exit code 0.
  std::string said(const Arguments& arguments) {
    const Finished finished = gcs(arguments);
    EXPECT_EQ(finished.exit_code, 0) << testing::PrintToString(arguments) << finished.err;
    return finished.out;
  }
  /// The same of one that must be refused.
  std::string refused(const Arguments& arguments, int code = 1) {
    const Finished finished = gcs(arguments);
    EXPECT_EQ(finished.exit_code, code) << testing::PrintToString(arguments) << finished.out;
    return finished.err;
  }
  /// Of `--json`.
  json told(const Arguments& arguments) { return json::parse(said(arguments), nullptr, false); }
  std::string content(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(VerbsFlight, OnTheGroundTheySayWhatThereIs) {
  EXPECT_THAT(said({"mode"}), testing::StartsWith("Grounded"));
  EXPECT_EQ(told({"mode", "--json"})["armed"], false);
  EXPECT_THAT(refused({"mode", "hover"}), HasSubstr("refused"));

  const json battery = told({"battery", "--json"});
  EXPECT_GT(battery["percentage"], 0.9);
  EXPECT_GT(battery["voltage_v"], 5.0);
  EXPECT_THAT(said({"battery"}), AllOf(HasSubstr("voltage"), HasSubstr("time left")));

  EXPECT_EQ(said({"param", "get", "planner", "max_speed"}),
            run({"param", "get", "planner", "max_speed"}).out);

  EXPECT_THAT(said({"map", "show", "--ascii", "--width", "60"}),
              AllOf(HasSubstr("^ N"), HasSubstr(">"), HasSubstr("the vehicle at 0.")));
  said({"map", "save", path("office.pgm")});
  const auto map = load_map(path("office.yaml"));
  ASSERT_TRUE(map.ok()) << map.error().reason;
  int walls = 0;
  for (int y = 0; y < map->height(); ++y) {
    for (int x = 0; x < map->width(); ++x) walls += map->state({x, y}) == CellState::kOccupied;
  }
  EXPECT_GT(walls, 50);
  said({"map", "save", path("office.png")});
  EXPECT_EQ(content("office.png").substr(1, 3), "PNG");

  const json cloud = told({"cloud", "save", path("office.pcd"), "--seconds", "1", "--json"});
  EXPECT_GT(cloud["points"], 100);
  EXPECT_GE(cloud["scans"], 5);
  EXPECT_THAT(content("office.pcd"),
              HasSubstr("POINTS " + std::to_string(cloud["points"].get<int>()) + "\n"));
  EXPECT_THAT(refused({"cloud", "save", path("none.ply"), "--topic", "none", "--patience", "1"}),
              HasSubstr("nothing is heard on 'none'"));
  EXPECT_EQ(content("none.ply"), "");
  stop_vehicle();
}

TEST_F(VerbsFlight, AMissionIsPutTogetherWaypointByWaypointAndFollowed) {
  Process log = start({"gcs", "log", "--json"});
  EXPECT_THAT(said({"waypoint", "list"}), HasSubstr("no mission"));
  EXPECT_EQ(said({"waypoint", "list", "--json"}), "[]\n");
  said({"waypoint", "add", "1.5", "1.05", "1.2"});
  said({"waypoint", "add", "-0.5", "1.05", "1.2", "--at", "1", "--yaw", "90"});
  said({"waypoint", "move", "1", "1.2", "1.05", "1.2"});
  said({"waypoint", "add", "2.0", "1.05", "1.2", "--hold", "2"});
  said({"waypoint", "remove", "2"});
  EXPECT_EQ(said({"waypoint", "list"}),
            "   1  goto 1.20 1.05 1.20 m, yaw 90 deg\n   2  goto 2.00 1.05 1.20 m, hold 2 s\n");
  EXPECT_THAT(refused({"waypoint", "remove", "3"}, 2), HasSubstr("items 1 to 2"));
  EXPECT_THAT(refused({"waypoint", "add", "1", "1", "1", "--speed", "2"}, 2),
              HasSubstr("only a waypoint on Earth"));

  const std::string file = write("hop.yaml",
                                 "items:\n  - takeoff: 1.2\n  - goto: {x: 1.5, y: 1.05, z: 1.2}\n"
                                 "  - hold: 6\n  - land\n");
  EXPECT_THAT(refused({"follow", file}), HasSubstr("not armed"));
  said({"arm", "--wait"});
  Process follow = start({"gcs", "follow", file, "--wait", "--json"});
  ASSERT_TRUE(status_becomes("flying", Seconds(20.0),
                             [](const json& status) { return status["height_m"] > 0.8; }));
  EXPECT_THAT(refused({"waypoint", "remove", "1"}), HasSubstr("flown"));
  EXPECT_EQ(told({"waypoint", "list", "--json"}).size(), 4u) << "it has the mission as it was";
  const auto flown = follow.wait(Seconds(60.0));
  ASSERT_TRUE(flown) << follow.err();
  EXPECT_EQ(flown->exit_code, 0) << flown->err;
  EXPECT_EQ(json::parse(flown->out)["done"], true);
  EXPECT_THAT(said({"mode"}), testing::StartsWith("Grounded"));

  expect_end(log, SIGINT, 0);
  std::istringstream lines(log.out());
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    all += json::parse(line)["text"].get<std::string>() + "\n";
  }
  for (const char* event :
       {"Grounded → Takeoff", "arm: accepted", "mission start refused: ", "mission of 4 items",
        "mission: flies from item 1 of 4", "mission refused: another one is being flown",
        "mission: all 4 items done"}) {
    EXPECT_THAT(all, HasSubstr(event));
  }
  stop_vehicle();
}

TEST_F(VerbsFlight, ModesAreCommandedByTheirNames) {
  said({"arm", "--wait"});
  EXPECT_THAT(said({"mode", "Takeoff", "--altitude", "1", "--wait"}),
              HasSubstr("takeoff: hovers at "));
  EXPECT_THAT(said({"mode"}), testing::StartsWith("Hover"));
  said({"mode", "Indoor", "Exploration"});
  EXPECT_EQ(status()["mode"], "Indoor Exploration");
  EXPECT_THAT(said({"map", "show", "--ascii"}), HasSubstr("the vehicle at 0."));
  said({"mode", "hover", "--wait"});
  const Finished down = run({"gcs", "mode", "land", "--wait"}, Seconds(30.0));
  EXPECT_EQ(down.exit_code, 0) << down.err;
  EXPECT_EQ(down.out, "land: landed\n");
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
