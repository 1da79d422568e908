// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mission_file_verbs.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "perception/map_io.hpp"
#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Outcome {
  int code = 0;
  std::string out, err;
};

/// As `swiftlet gcs mission` with these words.
Outcome run(std::vector<std::string> words) {
  CLI::App mission("test");
  mission.require_subcommand(1);
  add_mission_file_verbs(mission);
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  Outcome outcome;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  try {
    mission.parse(words);
  } catch (const CLI::RuntimeError& error) {
    outcome.code = error.get_exit_code();
  } catch (const CLI::ParseError&) {
    outcome.code = 2;  // as the program has it
  }
  std::fflush(stdout);
  outcome.out = ::testing::internal::GetCapturedStdout();
  outcome.err = ::testing::internal::GetCapturedStderr();
  return outcome;
}

class MissionFileCommands : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("swiftlet-mission-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text = {}) const {
    const std::filesystem::path path = folder_ / name;
    if (!text.empty()) std::ofstream(path) << text;
    return path.string();
  }

  std::filesystem::path folder_;
};

TEST_F(MissionFileCommands, ValidateSaysWhatIsWrongAndWhere) {
  const std::string good =
      file("good.yaml", "items: [takeoff: 1.2, goto: {x: 3, y: 0, z: 1.2}, land]\n");
  EXPECT_EQ(run({"validate", good}).code, 0);
  EXPECT_THAT(run({"validate", good}).out, HasSubstr("good.yaml: 3 items, 3 m, "));
  const Outcome fenced = run({"validate", good, "--fence-radius", "2"});
  EXPECT_EQ(fenced.code, 1);
  EXPECT_THAT(fenced.out,
              AllOf(HasSubstr("good.yaml:1: item 2: error: it is 3.0 m"), HasSubstr("1 error,")));
  const Outcome bad = run({"validate", file("bad.yaml", "items:\n  - lnad\n")});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, AllOf(HasSubstr("bad.yaml:2: "), HasSubstr("'land'")));
  EXPECT_EQ(run({"validate", file("absent.yaml")}).code, 2);
  EXPECT_EQ(run({"validate", file("mission.txt", "x")}).code, 2);
  EXPECT_EQ(run({"validate", good, "--fence-radius", "nan"}).code, 2);
}

TEST_F(MissionFileCommands, ValidatePrintsJson) {
  const std::string plan = mission_data("yard.plan").string();
  const Outcome outcome = run({"validate", plan, "--fence-height", "20", "--json"});
  EXPECT_EQ(outcome.code, 1);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["items"], 11);
  EXPECT_EQ(json["usable"], false);
  EXPECT_EQ(json["findings"][0]["severity"], "error");
  EXPECT_EQ(json["findings"][0]["item"], 5);
  EXPECT_GT(json["findings"][0]["line"], 30);
  EXPECT_GT(json["remarks"].size(), 5u);
}

TEST_F(MissionFileCommands, ValidateLooksIntoAMap) {
  OccupancyGrid::Params params;
  params.resolution = 0.1;
  OccupancyGrid grid(params, {-5, -5}, 100, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x)
      grid.set_state({x, y}, x == 70 ? CellState::kOccupied : CellState::kFree);
  }
  ASSERT_TRUE(save_map(grid, file("map.pgm")).ok());
  const std::string mission =
      file("m.yaml", "items:\n- takeoff: 1.2\n- goto: {x: 2.05, y: 0, z: 1.2}\n- land\n");
  EXPECT_EQ(run({"validate", mission}).code, 0);
  const Outcome outcome = run({"validate", mission, "--map", file("map.yaml")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out,
              HasSubstr("m.yaml:3: item 2: error: x 2.05, y 0.00 is inside an obstacle"));
  EXPECT_EQ(run({"validate", mission, "--map", file("none.yaml")}).code, 2);
}

TEST_F(MissionFileCommands, ConvertWritesEachFormAndSaysWhatIsLost) {
  const std::string plan = mission_data("yard.plan").string();
  const std::string yaml = file("yard.yaml"), list = file("yard.waypoints"),
                    again = file("again.plan");
  const Outcome first = run({"convert", plan, yaml});
  EXPECT_EQ(first.code, 0);
  EXPECT_THAT(first.err, HasSubstr("yard.plan:32: note: DO_SET_CAM_TRIGG_DIST (206): not "
                                   "supported; left out (and 1 more like it)"));
  EXPECT_EQ(run({"convert", yaml, again}).err, "");
  EXPECT_THAT(run({"convert", yaml, list}).err, HasSubstr("no fence"));
  const auto original = read_mission(plan);
  for (const std::string& name : {yaml, list, again}) {
    const auto mission = read_mission(name);
    ASSERT_TRUE(mission.ok()) << mission.error().reason;
    expect_same_items(*mission, *original);
  }
  const Outcome indoors =
      run({"convert", file("in.yaml", "items: [goto: {x: 1, y: 2, z: 1}]\n"), file("in.plan")});
  EXPECT_EQ(indoors.code, 1);
  EXPECT_THAT(indoors.err, HasSubstr("item 1 (line 1): a waypoint in the map"));
  EXPECT_FALSE(std::filesystem::exists(file("in.plan")));
  EXPECT_EQ(run({"convert", plan, file("x.kml")}).code, 2);
}

}  // namespace
}  // namespace swiftlet
