// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The papers' experiments, as somebody runs them.
#include <map>

#include "tests/data_folder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ExperimentVerb : public SystemTest {
 protected:
  /// Rows of an experiment whose goals are all met. The long form has the 20 seeds of the tables.
  std::map<std::string, nlohmann::json> rows(const Arguments& arguments) {
    Arguments all{"experiment"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--json", "--seeds", full_tests() ? "20" : "3"});
    const Finished finished = run(all, Seconds(full_tests() ? 600.0 : 120.0));
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    std::map<std::string, nlohmann::json> rows;
    const auto json = nlohmann::json::parse(finished.out, nullptr, false);
    if (json.is_discarded()) return rows;
    for (const auto& row : json["rows"]) rows[row["quantity"]] = row;
    return rows;
  }
};

TEST_F(ExperimentVerb, ListsWhatThereIs) {
  const Finished finished = run({"experiment", "list", "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const auto json = nlohmann::json::parse(finished.out);
  ASSERT_GE(json.size(), 4U);
  EXPECT_EQ(json[0]["name"], "smartphone-hover");
  EXPECT_THAT(run({"experiment", "list"}).out, HasSubstr("smartphone-trajectory"));
}

TEST_F(ExperimentVerb, TheHoverMeetsItsGoalsAndIsDrawn) {
  const auto all = rows({"smartphone-hover", "--report", path("figures")});
  ASSERT_TRUE(all.count("position RMSE, UKF to phone, z"));
  // The phone of the simulation is the phone of Table 2.
  EXPECT_NEAR(all.at("position RMSE of the phone, y")["median"], 0.032, 0.008);
  EXPECT_NEAR(all.at("RMSE of Psi of the phone")["median"], 0.0627, 0.006);
  EXPECT_EQ(all.at("velocity RMSE of the UKF, x")["reference"], 0.0651);
  for (const char* figure : {"figure-07.png", "figure-08.png"}) {
    EXPECT_GT(std::filesystem::file_size(folder() / "figures" / figure), 10'000U) << figure;
  }
}

TEST_F(ExperimentVerb, TheOvalMeetsItsGoalsAndIsDrawn) {
  const auto all = rows({"smartphone-trajectory", "--report", path("figures")});
  EXPECT_GE(all.size(), 36U);
  for (const char* figure : {"figure-10.png", "figure-11.png", "figure-12.png"}) {
    EXPECT_GT(std::filesystem::file_size(folder() / "figures" / figure), 10'000U) << figure;
  }
}

TEST_F(ExperimentVerb, TheFilterBeatsItsPosesOnARealImu) {
  SWIFTLET_SKIP_WITHOUT(data_folder() / "euroc");
  EXPECT_FALSE(rows({"euroc-filter", "--data", (data_folder() / "euroc").string()}).empty());
}

TEST_F(ExperimentVerb, TheHouseIsExploredWholeAndDrawn) {
  const Finished finished =
      run({"experiment", "exploration", "--json", "--seeds", "1", "--report", path("figures")});
  std::map<std::string, nlohmann::json> all;
  const auto json = nlohmann::json::parse(finished.out, nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << finished.err;
  for (const auto& row : json["rows"]) all[row["quantity"]] = row;
  for (const char* goal :
       {"explored, returned and landed", "share mapped of what can be reached", "contacts"}) {
    ASSERT_TRUE(all.count(goal)) << goal;
    EXPECT_TRUE(all.at(goal)["holds"]) << goal;
  }
  EXPECT_GT(all.at("length flown")["median"], 40.0);
  for (const char* figure : {"exploration.png", "exploration-nearest.png"}) {
    EXPECT_GT(std::filesystem::file_size(folder() / "figures" / figure), 10'000U) << figure;
  }
}

TEST_F(ExperimentVerb, SaysWhatIsMissing) {
  const Finished without = run({"experiment", "euroc-filter"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, AllOf(HasSubstr("--data"), HasSubstr("README")));
  const Finished empty = run({"experiment", "euroc-filter", "--data", folder().string()});
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.err, AllOf(HasSubstr("imu*.csv"), HasSubstr(folder().string())));
  const Finished unknown = run({"experiment", "smartphone-hoover"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'smartphone-hover'?"));
}

}  // namespace
}  // namespace swiftlet::test
