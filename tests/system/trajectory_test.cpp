// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// `swiftlet trajectory`, on good files and on bad ones.
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/system/bad_input.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kOval = SWIFTLET_SOURCE_DIR "/components/cli/trajectories/oval.yaml";
const std::string kLine = R"(start: {position: [0, 0, 1]}
waypoints:
  - {position: [2, 0, 1], yaw: 0.5, velocity: [0.8, 0, 0]}
  - {position: [4, 1, 1.5]}
)";

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The rows of a CSV file below its header.
std::vector<std::vector<double>> rows_of(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(stream, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

class TrajectoryVerb : public SystemTest {
 protected:
  /// The extreme of a quantity in the output of --json.
  static double extreme(const json& output, const std::string& quantity) {
    for (const json& row : output["rows"]) {
      if (row["quantity"] == quantity) return row["extreme"];
    }
    ADD_FAILURE() << "no " << quantity;
    return std::nan("");
  }
};

TEST_F(TrajectoryVerb, TheOvalOfSeed000TakesItsNineSeconds) {
  const Finished done =
      run({"trajectory", kOval, "--plot", path("oval.png"), "--csv", path("oval.csv"), "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json output = json::parse(done.out);
  EXPECT_NEAR(output["duration_s"], 9.0, 1e-6);
  EXPECT_EQ(output["pieces_s"].size(), 3u);
  EXPECT_NEAR(extreme(output, "max_speed"), 1.0, 0.3);  // "reaches values of 1 m/s"

  const auto rows = rows_of(path("oval.csv"));
  ASSERT_EQ(rows.size(), 901u);  // 100 Hz, both ends
  double fastest = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 22u);
    EXPECT_NEAR(rows[i][0], 0.01 * static_cast<double>(i), 1e-6);
    fastest = std::max(fastest, std::hypot(rows[i][4], rows[i][5], rows[i][6]));
    sum += 0.01 * rows[i][4];
    // Velocities are what positions change by.
    if (i > 0) {
      EXPECT_NEAR(rows[i][1] - rows[i - 1][1], 0.005 * (rows[i][4] + rows[i - 1][4]), 1e-4);
    }
  }
  EXPECT_NEAR(sum, 0.0, 1e-3);  // back where it began
  EXPECT_LE(fastest, extreme(output, "max_speed") + 1e-9);
  EXPECT_GT(fastest, 0.999 * extreme(output, "max_speed"));
  EXPECT_EQ(content_of(path("oval.png")).substr(1, 3), "PNG");
}

TEST_F(TrajectoryVerb, TellsAPersonTheLimitsBesideTheExtrema) {
  const Finished done = run({"trajectory", kOval});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const char* words : {"duration   9.000 s, 3 pieces", "cost", "max_speed", "1.5 m/s",
                            "max_thrust_per_mass", "14 m/s^2", "max_body_rate", "3 rad/s"}) {
    EXPECT_THAT(done.out, HasSubstr(words));
  }
}

TEST_F(TrajectoryVerb, WithoutADurationItIsAsShortAsTheLimitsAllow) {
  const Finished done =
      run({"trajectory", write("line.yaml", kLine), "--csv", path("line.csv"), "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json output = json::parse(done.out);
  double used = 0.0;
  for (const json& row : output["rows"]) {
    if (row["limit"].is_null()) continue;
    used = std::max(used, row["extreme"].get<double>() / row["limit"].get<double>());
  }
  EXPECT_LE(used, 1.0);
  EXPECT_GT(used, 0.9);
  // It passes the first waypoint as that says, and keeps the yaw after it.
  const double at = output["pieces_s"][0];
  const auto rows = rows_of(path("line.csv"));
  const auto& before = rows[static_cast<std::size_t>(at * 100.0)];
  EXPECT_NEAR(before[4], 0.8, 0.02);
  EXPECT_NEAR(before[5], 0.0, 0.02);
  EXPECT_NEAR(rows.back()[16], 0.5, 1e-6);
  EXPECT_NEAR(rows.back()[1], 4.0, 1e-6);
}

TEST_F(TrajectoryVerb, SaysWhichLimitADurationBreaksAndHowLongItWouldHaveToBe) {
  const std::string file = write("short.yaml", kLine + "duration_s: 3.0\n");
  const Finished done = run({"trajectory", file, "--csv", path("short.csv")});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("short.yaml: in 3 s the speed reaches"));
  EXPECT_THAT(done.err, HasSubstr("above the limit of 1 m/s"));
  EXPECT_FALSE(std::filesystem::exists(path("short.csv")));
}

TEST_F(TrajectoryVerb, AMissingGnuplotIsAReasonToFail) {
  environment_["PATH"] = folder().string();
  const Finished done = run({"trajectory", kOval, "--plot", path("oval.png")});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("install the package gnuplot-nox"));
}

BadInput way(const std::string& name, const std::string& content,
             const std::vector<std::string>& says) {
  return {name,
          {"trajectory", "{in}/way.yaml", "--csv", "{out}/way.csv", "--plot", "{out}/way.png"},
          says,
          {{"way.yaml", content}}};
}

class BadTrajectory : public BadInputTest, public testing::WithParamInterface<BadInput> {};
TEST_P(BadTrajectory, IsRefused) {
  expect_refused(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    File, BadTrajectory,
    testing::Values(
        BadInput{"Missing", {"trajectory", "{in}/none.yaml"}, {"none.yaml: cannot be read"}},
        way("Empty", "", {"'start' is missing"}), way("Malformed", "start: [", {"way.yaml:1"}),
        way("NoWaypoints", "start: {position: [0, 0, 1]}\n", {"'waypoints' is missing"}),
        way("EmptyWaypoints", "start: {position: [0, 0, 1]}\nwaypoints: []\n",
            {"way.yaml:2: ", "add at least one"}),
        way("NoPosition", "start: {position: [0, 0, 1]}\nwaypoints:\n  - {yaw: 1}\n",
            {"way.yaml:3: ", "'position' is missing"}),
        way("PositionInThePlane", "start: {position: [0, 0]}\nwaypoints: [{position: [1, 0, 1]}]\n",
            {"way.yaml:1: ", "'position' must have 3 numbers, not 2"}),
        way("UnknownKey", kLine + "limts: {max_speed: 1}\n",
            {"way.yaml:5: ", "did you mean 'limits'?"}),
        way("UnknownLimit", kLine + "limits:\n  max_sped: 1\n",
            {"way.yaml:6: ", "did you mean 'max_speed'?"}),
        way("UnknownInAWaypoint", kLine + "  - {position: [1, 1, 1], yaww: 0}\n",
            {"way.yaml:5: ", "did you mean 'yaw'?"}),
        way("NoSpeed", kLine + "limits: {max_speed: 0}\n", {"way.yaml:5: ", "must be positive"}),
        way("LessThrustThanAHover", kLine + "limits:\n  max_thrust_per_mass: 9\n",
            {"way.yaml:6: ", "at least 9.8"}),
        way("NotANumber", kLine + "duration_s: .nan\n", {"way.yaml:5: ", "finite number"}),
        way("InfinitePlace", "start: {position: [0, 0, .inf]}\n", {"way.yaml:1: ", "finite"}),
        way("FarAway", "start: {position: [0, 0, 1e300]}\n", {"way.yaml:1: ", "from -1000000"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Output, BadTrajectory,
    testing::Values(BadInput{"NoFile", {"trajectory"}, {"waypoints", "required"}},
                    BadInput{"CsvInNoFolder",
                             {"trajectory", kOval, "--csv", "{out}/none/oval.csv"},
                             {"--csv", "there is no folder", "make it"}},
                    BadInput{"CsvThatIsAFolder",
                             {"trajectory", kOval, "--csv", "{in}"},
                             {"--csv {in}: a folder is there"}},
                    BadInput{"PlotThatIsNoPng",
                             {"trajectory", kOval, "--plot", "{out}/oval.pdf"},
                             {"--plot", "end it with .png"}}),
    name_of);

}  // namespace
}  // namespace swiftlet::test
