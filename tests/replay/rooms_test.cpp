// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A flight through the office, and what the scans alone tell of its rooms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;

class MeasuredRooms : public test::SystemTest {
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

/// The room whose middle is nearest to a place in it.
const json& nearest(const json& rooms, const TrueRoom& truth) {
  const auto apart = [&truth](const json& room) {
    return std::hypot(room["x_m"].get<double>() - truth.x, room["y_m"].get<double>() - truth.y);
  };
  return *std::min_element(rooms.begin(), rooms.end(),
                           [&apart](const json& a, const json& b) { return apart(a) < apart(b); });
}

TEST_F(MeasuredRooms, OfTheOfficeAreMeasuredToAPercentByWhoeverFlewThroughThem) {
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
    const json& found = nearest(rooms, truth);
    EXPECT_NEAR(found["area_m2"].get<double>(), truth.area, 0.01 * truth.area);
    EXPECT_NEAR(found["length_m"].get<double>(), truth.length, 0.01 * truth.length);
    EXPECT_NEAR(found["width_m"].get<double>(), truth.width, 0.01 * truth.width);
  }
}

/// From components/sim/worlds/house.sdf: between the walls, and what of the floor is free at the
/// height of the scanner. Living room and hall are one, through an opening of 1.4 m.
constexpr TrueRoom kHouse[] = {
    {"living room and hall", 2.2, 1.8, 14.0, 5.74, 43.08},
    {"kitchen", 7.3, 2.1, 3.38, 4.14, 13.61},
    {"office", 11.0, 2.3, 4.88, 4.14, 19.15},
    {"bedroom 1", 1.7, 7.0, 4.40, 4.14, 17.07},
    {"bathroom", 5.7, 7.9, 2.38, 4.14, 9.10},
    {"bedroom 2", 8.7, 7.7, 3.38, 4.14, 13.02},
    {"study", 11.4, 8.5, 3.48, 4.14, 13.78},
};

TEST_F(MeasuredRooms, OfTheHouseAreThoseOfItsPlan) {
  const std::string flight = path("house.mcap"), map = path("map.mcap");
  must_run({"--log", "warning", "fly", SWIFTLET_SOURCE_DIR "/tests/replay/house_rooms.yaml",
            "--record", flight});
  // What is lower than the tables is not what a floor plan shows.
  must_run({"--log", "warning", "replay", flight, "--into", "lidar_mapper", "--param",
            "lidar_mapper.slam=true", "--param", "lidar_mapper.min_height=0.9", "--param",
            "lidar_mapper.max_height=1.6", "--param", "lidar_mapper.save=" + map});
  const json rooms = json::parse(must_run({"map", "rooms", map, "--json"}).out, nullptr, false);
  ASSERT_TRUE(rooms.is_array());
  EXPECT_EQ(rooms.size(), std::size(kHouse));
  double worst = 0.0, worst_floor = 0.0;
  for (const TrueRoom& truth : kHouse) {
    SCOPED_TRACE(truth.name);
    const json& room = nearest(rooms, truth);
    const auto error = [&room](const char* key, double expected) {
      return std::abs(room[key].get<double>() / expected - 1.0);
    };
    const double plan = truth.length * truth.width;
    const double off = std::max({error("length_m", truth.length), error("width_m", truth.width),
                                 // The two that are one are no rectangle, but their walls span one.
                                 error("plan_area_m2", plan)});
    EXPECT_LT(off, 0.01);
    EXPECT_LT(error("area_m2", truth.area), 0.02) << "corners behind furniture are not seen";
    worst = std::max(worst, off);
    worst_floor = std::max(worst_floor, error("area_m2", truth.area));
  }
  std::printf("worst of lengths, widths and plan areas: %.2f %%; of free floors %.2f %%\n",
              100.0 * worst, 100.0 * worst_floor);
}

TEST_F(MeasuredRooms, MapFilesThatCannotBeUsedAreRefused) {
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
