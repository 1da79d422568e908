// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Every mode by the commands of a ground station and the sticks of a remote control, with the whole
// stack in lockstep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "estimation/geodesy/local_origin.hpp"
#include "mode_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
namespace code = swiftlet_msgs::msg::ModeCommand_Constants;

bool full_tests() {
  const char* value = std::getenv("SWIFTLET_FULL_TESTS");
  return value != nullptr && std::string(value) == "1";
}

/// Of a place from the nearest wall of courtyard.sdf [m].
double wall_distance(const Eigen::Vector3d& p) {
  const auto from_box = [&](double x, double y, double width, double depth) {
    return Eigen::Vector2d(std::max(std::abs(p.x() - x) - 0.5 * width, 0.0),
                           std::max(std::abs(p.y() - y) - 0.5 * depth, 0.0))
        .norm();
  };
  return std::min({p.x(), p.y(), 10.0 - p.x(), 8.0 - p.y(), from_box(6.0, 5.75, 0.2, 4.5),
                   (p.head<2>() - Eigen::Vector2d(8.2, 2.6)).norm() - 0.3});
}

TEST(Modes, AllEightInOneFlight) {
  ModeFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  flight.take_off();

  flight.add({"navigate",
              [&] {
                pilot.go_to({8.5, 6.5, 1.2});
              },
              [&] { return pilot.is_in("Indoor Navigation"); },
              5.0,
              {}});
  flight.until("Hover");
  flight.check([&] { EXPECT_LT((pilot.truth - Eigen::Vector3d(8.5, 6.5, 1.2)).norm(), 0.3); });

  flight.order(code::EXPLORE, "Indoor Exploration");
  flight.until("Hover", 200.0);
  flight.check([&] {
    EXPECT_LT((pilot.truth - Eigen::Vector3d(3.0, 4.0, 1.2)).norm(), 0.4);
    EXPECT_TRUE(pilot.status.mission_done());
  });

  flight.order(code::MANUAL, "Manual");
  flight.hold({0.0, -0.6, 0.3, 0.5, false}, 2.0);
  flight.wait(2.0);
  flight.check([&] {
    EXPECT_TRUE(pilot.is_in("Manual"));
    EXPECT_LT(pilot.truth.y(), 3.5);
    EXPECT_GT(pilot.truth.z(), 1.3);
  });

  flight.order(code::ASSIST, "Assisted Manual");
  flight.hold({-1.0, 0.0, 0.0, 0.0, true}, 8.0);
  flight.check(
      [&] { EXPECT_NEAR(wall_distance(pilot.truth), 0.555, 0.05) << pilot.truth.transpose(); });

  const LocalOrigin origin({47.397742, 8.545594, 488.0});
  const Eigen::Vector3d beyond_the_wall(3.0, 11.0, 3.5);
  const GlobalPosition there = origin.to_global(beyond_the_wall);
  flight.add({"gps",
              [&] {
                pilot.go_to_global({there.latitude, there.longitude, 3.5});
              },
              [&] { return pilot.is_in("GPS Guidance"); },
              5.0,
              {}});
  flight.until("Hover");
  flight.check([&] { EXPECT_LT((pilot.truth - beyond_the_wall).head<2>().norm(), 0.6); });
  flight.add({"gps back",
              [&] {
                pilot.go_to_global({47.397742, 8.545594, 3.0});
              },
              [&] { return pilot.is_in("GPS Guidance"); },
              5.0,
              {}});
  flight.wait(2.0);

  flight.order(code::RETURN, "GPS Guidance");
  flight.until("Land", 60.0);
  flight.until("Grounded", 60.0);
  flight.fly();
  EXPECT_LT((pilot.truth - Eigen::Vector3d(3.0, 4.0, 0.1)).head<2>().norm(), 0.2);
  EXPECT_GT(pilot.clearance, 0.05);
  EXPECT_FALSE(pilot.guard_acting);
  EXPECT_EQ(pilot.guard_reason, "") << "there was nothing to guard against";
}

TEST(Modes, ReleasedSticksHoldThePlace) {
  ModeFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  double worst = 0.0;
  flight.take_off();
  flight.order(code::MANUAL, "Manual");
  for (const Sticks& sticks :
       {Sticks{1.0, 0.0, 0.0, 0.0, false}, Sticks{-0.7, 0.7, 0.0, 0.0, false},
        Sticks{0.0, -1.0, 0.4, 1.0, false}}) {
    flight.hold(sticks, 1.5);
    flight.wait(2.0);  // comes to rest
    const auto place = std::make_shared<Eigen::Vector3d>();
    flight.check([&pilot, place] { *place = pilot.truth; });
    flight.add({"stay",
                [] {},
                [&pilot, &worst, place] {
                  worst = std::max(worst, (pilot.truth - *place).norm());
                  return pilot.step_s > 10.0;
                },
                12.0,
                {}});
  }
  flight.land();
  flight.fly();
  EXPECT_LT(worst, 0.10);
  RecordProperty("worst_m", std::to_string(worst));
}

/// Full sticks at the walls from a hundred angles (SWIFTLET_FULL_TESTS=1), else from ten.
TEST(Modes, AssistedAtFullStickStopsAtTheDistanceFromEveryAngle) {
  ModeFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  const int angles = full_tests() ? 100 : 10;
  double worst = 0.0;
  flight.take_off();
  for (int i = 0; i < angles; ++i) {
    const double angle = 2.0 * M_PI * i / angles;
    flight.order(code::ASSIST, "Assisted Manual");
    const Sticks sticks{std::cos(angle), std::sin(angle), 0.0, 0.0, true};
    flight.add({"full stick", [] {},
                [&pilot] { return pilot.step_s > 4.0 && pilot.velocity.norm() < 0.03; }, 20.0,
                sticks});
    flight.hold(sticks, 2.0);
    flight.check([&, angle] {
      const double off = wall_distance(pilot.truth) - 0.555;
      EXPECT_NEAR(off, 0.0, 0.05) << angle << " at " << pilot.truth.transpose();
      EXPECT_TRUE(pilot.is_in("Assisted Manual"));
      worst = std::max(worst, std::abs(off));
    });
    flight.add({"back",
                [&] {
                  pilot.go_to({3.0, 4.0, 1.2});
                },
                [&] { return pilot.is_in("Indoor Navigation"); },
                5.0,
                {}});
    flight.until("Hover");
  }
  flight.land();
  flight.fly();
  RecordProperty("worst_m", std::to_string(worst));
  std::printf("%d angles: worst %.3f m off the distance\n", angles, worst);
}

// --- what goes wrong --------------------------------------------------------------------------

enum class Wrong { kLidarDead, kPlannerKilled, kMapCorrupt, kGuardKilled };

struct FaultCase {
  const char* mode;
  Wrong wrong;
};

std::string name_of(const FaultCase& c) {
  std::string name = c.mode;
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  switch (c.wrong) {
    case Wrong::kLidarDead:
      return name + "LidarDead";
    case Wrong::kPlannerKilled:
      return name + "PlannerKilled";
    case Wrong::kMapCorrupt:
      return name + "MapCorrupt";
    case Wrong::kGuardKilled:
      return name + "GuardKilled";
  }
  return name;
}

class FaultTable : public ::testing::TestWithParam<FaultCase> {};

/// What a map is not: walls everywhere that no scanner saw, and fewer cells than it says.
nav_msgs::msg::OccupancyGrid corrupt_map(Time now) {
  nav_msgs::msg::OccupancyGrid map;
  map.header(make_header(now, frame::kMap));
  map.info().resolution(std::nanf(""));
  map.info().width(4000000000u);
  map.info().height(3);
  map.data().assign(7, 100);
  return map;
}

/// Goes on saying what the mapper said of itself, and sends maps that are none.
struct MadMapper {
  explicit MadMapper(ScriptedPilot& pilot) {
    const std::string alive = topic::alive_name("lidar_mapper");
    const Topic<swiftlet_msgs::msg::ComponentStatus> sign{alive.c_str(), topic::alive_qos};
    pilot.subscribe(sign, [this](const auto& heard) {
      if (!acts) last_sign = heard;
    });
    pilot.subscribe(topic::component_status, [this](const auto& heard) {
      if (!acts && heard.component_name() == "lidar_mapper") last_status = heard;
    });
    pilot.every(std::chrono::milliseconds(20),
                [this, &pilot, signs = pilot.advertise(sign),
                 states = pilot.advertise(topic::component_status)](Time now) mutable {
                  if (!acts) return;
                  pilot.send_map(corrupt_map(now));
                  signs.publish(last_sign);
                  states.publish(last_status);
                });
  }

  bool acts = false;
  swiftlet_msgs::msg::ComponentStatus last_sign, last_status;
};

TEST_P(FaultTable, NothingIsTouchedAndTheReasonIsTold) {
  const FaultCase& c = GetParam();
  const std::string mode = c.mode;
  const bool planned = mode == "Indoor Navigation" || mode == "Indoor Exploration";
  const bool sees = planned || mode == "Assisted Manual" || mode == "GPS Guidance";
  // The LIDAR dies by itself: in the climb, or some time after it.
  const char* kDeath = mode == "Takeoff" ? "drop scan 100% @9..600" : "drop scan 100% @14.5..600";
  std::vector<Fault> faults;
  if (c.wrong == Wrong::kLidarDead) faults.push_back(parse_fault(kDeath));
  const bool corrupt = c.wrong == Wrong::kMapCorrupt;
  ModeFlight flight("", faults);
  ScriptedPilot& pilot = flight.pilot();
  MadMapper mad_mapper(pilot);

  Sticks sticks;
  if (mode == "Takeoff") {
    flight.add({"ready", [] {}, [&] { return pilot.status.ready(); }, 30.0, {}});
    flight.add(
        {"arm", [&] { pilot.command(code::ARM); }, [&] { return pilot.status.armed(); }, 5.0, {}});
    flight.order(code::TAKEOFF, "Takeoff", 1.2);
  } else {
    flight.take_off();
    if (mode == "Land") flight.order(code::LAND, "Land");
    if (mode == "Manual") {
      flight.order(code::MANUAL, "Manual");
      sticks = {0.0, -0.3, 0.0, 0.0, false};
    }
    if (mode == "Assisted Manual") {
      flight.order(code::ASSIST, "Assisted Manual");
      sticks = {1.0, 0.0, 0.0, 0.0, true};
    }
    if (mode == "GPS Guidance") {
      const GlobalPosition there =
          LocalOrigin({47.397742, 8.545594, 488.0}).to_global({3.0, 40.0, 3.5});
      flight.add({"gps",
                  [&pilot, there] {
                    pilot.go_to_global({there.latitude, there.longitude, 3.5});
                  },
                  [&] { return pilot.is_in("GPS Guidance"); },
                  5.0,
                  {}});
    }
    if (mode == "Indoor Navigation") {
      flight.add({"navigate",
                  [&] {
                    pilot.go_to({8.5, 6.5, 1.2});
                  },
                  [&] { return pilot.is_in("Indoor Navigation"); },
                  5.0,
                  {}});
    }
    if (mode == "Indoor Exploration") flight.order(code::EXPLORE, "Indoor Exploration");
  }
  if (mode != "Takeoff") flight.hold(sticks, 1.0);
  flight.add({"goes wrong",
              [&] {
                if (c.wrong == Wrong::kPlannerKilled) flight.kill("planner");
                if (c.wrong == Wrong::kGuardKilled) flight.kill("guard");
                if (!corrupt) return;
                flight.kill("lidar_mapper");
                mad_mapper.acts = true;
              },
              [] { return true; }, 60.0, sticks});
  const bool ends = (c.wrong == Wrong::kLidarDead && sees) ||
                    (c.wrong == Wrong::kPlannerKilled && planned) || (corrupt && planned);
  if (ends) {
    flight.add({"stops", [] {}, [&] { return pilot.is_in("Hover"); }, 6.0, sticks});
    flight.check([&] {
      const char* culprit = c.wrong == Wrong::kPlannerKilled ? "planner"
                            : corrupt                        ? "what comes on it is no map"
                            : planned                        ? "lidar_mapper"
                                                             : "LIDAR";
      EXPECT_THAT(pilot.status.reason(), HasSubstr(culprit));
    });
  } else {
    flight.add({"goes on", [] {}, [&] { return pilot.step_s > 6.0; }, 10.0, sticks});
    if (c.wrong == Wrong::kLidarDead) {
      flight.check(
          [&] { EXPECT_THAT(pilot.log, Contains(HasSubstr("lidar_mapper cannot work: scan"))); });
    }
    if (corrupt) {
      flight.check([&] {
        EXPECT_THAT(pilot.log,
                    Contains(HasSubstr("planner cannot work: map: what comes on it is no map")));
      });
    }
    if (c.wrong == Wrong::kPlannerKilled) {
      flight.check([&] { EXPECT_THAT(pilot.log, Contains(HasSubstr("planner"))); });
    }
    if (c.wrong == Wrong::kGuardKilled) {
      flight.check([&] { EXPECT_THAT(pilot.log, Contains(HasSubstr("guard is silent"))); });
    }
  }
  flight.add({"down",
              [&] { pilot.command(code::LAND); },
              [&] { return pilot.is_in("Grounded"); },
              60.0,
              {}});
  flight.fly();
  EXPECT_EQ(pilot.contacts, 0u);
}

std::vector<FaultCase> fault_table() {
  std::vector<FaultCase> cases;
  for (const char* mode : {"Takeoff", "Hover", "Land", "Manual", "Assisted Manual", "GPS Guidance",
                           "Indoor Navigation", "Indoor Exploration"}) {
    for (const Wrong wrong :
         {Wrong::kLidarDead, Wrong::kPlannerKilled, Wrong::kMapCorrupt, Wrong::kGuardKilled}) {
      cases.push_back({mode, wrong});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Modes, FaultTable, ::testing::ValuesIn(fault_table()),
                         [](const auto& tested) { return name_of(tested.param); });

}  // namespace
}  // namespace swiftlet::test
