// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/battery_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace swiftlet {
namespace {

TEST(BatteryView, SaysWhatIsKnown) {
  const BatteryView battery{{0.875, 15.25, 12.5, 3.0}, 864.0};
  EXPECT_EQ(describe(battery),
            "charge    88 %\nvoltage   15.2 V\ncurrent   12.5 A\ntime left 14 min\n");
  const auto json = nlohmann::json::parse(to_json(battery));
  EXPECT_EQ(json, (nlohmann::json{{"percentage", 0.875},
                                  {"voltage_v", 15.25},
                                  {"current_a", 12.5},
                                  {"charge_ah", 3.0},
                                  {"time_left_s", 864.0}}));
  EXPECT_THAT(describe({{0.1, 13.0, 20.0, 0.3}, 54.0}), testing::HasSubstr("time left 54 s"));
}

TEST(BatteryView, SaysWhatIsNot) {
  const double none = std::nan("");
  const BatteryView battery{{none, 15.2, none, none}, std::nullopt};
  EXPECT_EQ(describe(battery), "charge    ?\nvoltage   15.2 V\ncurrent   ?\ntime left ?\n");
  const auto json = nlohmann::json::parse(to_json(battery));
  EXPECT_TRUE(json["percentage"].is_null());
  EXPECT_TRUE(json["current_a"].is_null());
  EXPECT_TRUE(json["time_left_s"].is_null());
  EXPECT_EQ(json["voltage_v"], 15.2);
}

}  // namespace
}  // namespace swiftlet
