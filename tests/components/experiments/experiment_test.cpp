// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/experiment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

ExperimentRow row(std::vector<double> values, std::optional<double> goal, bool more_is_better) {
  ExperimentRow row;
  row.quantity = "position RMSE, x";
  row.unit = "m";
  row.reference = 0.02;
  row.source = "Table 2";
  row.values = std::move(values);
  row.goal = goal;
  row.more_is_better = more_is_better;
  return row;
}

TEST(ExperimentRow, WorstIsWhatTheGoalIsHeldAgainst) {
  const ExperimentRow less = row({3, 1, 2, 10}, 9.0, false);
  EXPECT_EQ(less.median(), 2.5);
  EXPECT_EQ(less.worst(), 10.0);
  EXPECT_FALSE(less.holds());
  EXPECT_TRUE(row({3, 1, 2}, 3.0, false).holds());
  const ExperimentRow more = row({3, 1, 2}, 2.0, true);
  EXPECT_EQ(more.median(), 2.0);
  EXPECT_EQ(more.worst(), 1.0);
  EXPECT_FALSE(more.holds());
  EXPECT_TRUE(row({5.0}, {}, false).holds());
  ExperimentRow of_median = row({3, 1, 2}, 2.5, false);
  EXPECT_FALSE(of_median.holds());
  of_median.goal_is_of_median = true;
  EXPECT_TRUE(of_median.holds());
}

TEST(ExperimentRow, WhatIsNoNumberDoesNotHold) {
  const double nan = std::nan("");
  EXPECT_FALSE(row({1, nan, 2}, 9.0, false).holds());
  EXPECT_FALSE(row({1, nan, 2}, 0.0, true).holds());
  EXPECT_FALSE(row({}, 9.0, false).holds());
  EXPECT_FALSE(row({1, INFINITY}, 9.0, false).holds());
}

TEST(Experiment, TableAndJsonSayWhatHoldsAndWhatNot) {
  const ExperimentResult result{"hover",
                                3,
                                {row({0.01, 0.02, 0.03}, 0.04, false),
                                 row({0.9, 0.8, 0.7}, 0.75, true), row({INFINITY}, 2.0, false)}};
  EXPECT_FALSE(result.holds());
  EXPECT_THAT(to_table(result),
              AllOf(HasSubstr("hover, 3 runs"), HasSubstr("< 0.0400"), HasSubstr("> 0.7500"),
                    HasSubstr("MISSED"), HasSubstr("2 of 3 goals are missed")));
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_EQ(json["name"], "hover");
  EXPECT_EQ(json["seeds"], 3);
  ASSERT_EQ(json["rows"].size(), 3U);
  EXPECT_EQ(json["rows"][0]["quantity"], "position RMSE, x");
  EXPECT_EQ(json["rows"][0]["median"], 0.02);
  EXPECT_EQ(json["rows"][0]["worst"], 0.03);
  EXPECT_EQ(json["rows"][0]["goal"], 0.04);
  EXPECT_EQ(json["rows"][0]["holds"], true);
  EXPECT_EQ(json["rows"][1]["worst"], 0.7);
  EXPECT_EQ(json["rows"][1]["holds"], false);
  EXPECT_TRUE(json["rows"][2]["worst"].is_null());
  const ExperimentResult good{"hover", 1, {row({0.01}, 0.04, false)}};
  EXPECT_TRUE(good.holds());
  EXPECT_THAT(to_table(good), AllOf(HasSubstr("1 run\n"), HasSubstr("all 1 goals are met"),
                                    Not(HasSubstr("MISSED"))));
}

TEST(Experiment, NamesAreDifferent) {
  std::set<std::string> names;
  for (const Experiment& experiment : experiments()) {
    EXPECT_TRUE(names.insert(experiment.name).second) << experiment.name;
    EXPECT_NE(experiment.run, nullptr);
  }
  EXPECT_GE(names.size(), 4U);
}

}  // namespace
}  // namespace swiftlet
