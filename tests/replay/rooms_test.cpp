// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A flight through the office, and what the scans alone tell of its rooms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;

class OfficeRooms : public test::SystemTest {
 protected:
  test::Finished must_run(const Arguments& arguments) {
    test::Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished;
  }
};

/// From components/sim/worlds/office.sdf: walls, and what stands on the floor at the height of the
/// scanner; doorways count half.
struct TrueRoom {
  const char* name;
  double x, y;  // somewhere in it
  double length, width, area;
};
constexpr double kDoorway = 0.9 * 0.06;
constexpr TrueRoom kRooms[] = {
    {"room 2", 5.5, 3.2, 4.22, 4.08, 4.22 * 4.08 - 0.4 * 1.6 - 0.08 * 1.4 + kDoorway},
    {"room 3", 11.7, 5.0, 4.12, 4.08, 4.12 * 4.08 - 0.5 * 1.2 - M_PI * 0.2 * 0.2 + kDoorway},
};

TEST_F(OfficeRooms, AreMeasuredToAPercentByWhoeverFlewThroughThem) {
  const std::string flight = path("office.mcap"), map = path("map.mcap");
  must_run({"--log", "warning", "fly", test::office(), "--record", flight});
  must_run({"--log", "warning", "replay", flight, "--into", "lidar_mapper", "--param",
            "lidar_mapper.slam=true", "--param", "lidar_mapper.save=" + map});
  const auto surveyed = must_run(
      {"map", "rooms", map, "--widest-door", "1.7", "--json", "--draw", path("rooms.png")});
  EXPECT_TRUE(std::filesystem::exists(path("rooms.png")));
  const json rooms = json::parse(surveyed.out, nullptr, false);
  ASSERT_TRUE(rooms.is_array()) << surveyed.out;
  EXPECT_GE(rooms.size(), 4U);  // the copier parts the corridor
  for (const TrueRoom& truth : kRooms) {
    SCOPED_TRACE(truth.name);
    const auto found =
        std::min_element(rooms.begin(), rooms.end(), [&](const json& a, const json& b) {
          const auto apart = [&](const json& room) {
            return std::hypot(room["x_m"].get<double>() - truth.x,
                              room["y_m"].get<double>() - truth.y);
          };
          return apart(a) < apart(b);
        });
    EXPECT_NEAR((*found)["area_m2"].get<double>(), truth.area, 0.01 * truth.area);
    EXPECT_NEAR((*found)["length_m"].get<double>(), truth.length, 0.01 * truth.length);
    EXPECT_NEAR((*found)["width_m"].get<double>(), truth.width, 0.01 * truth.width);
  }
}

TEST_F(OfficeRooms, MapFilesThatCannotBeUsedAreRefused) {
  const test::Finished missing = run({"map", "info", path("nowhere.mcap")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, testing::HasSubstr("nowhere.mcap"));
  const test::Finished alone = run({"map", "merge", path("a.mcap"), "-o", path("b.mcap")});
  EXPECT_EQ(alone.exit_code, 2);
  const test::Finished without = run({"map"});
  EXPECT_EQ(without.exit_code, 2);
}

}  // namespace
}  // namespace swiftlet
