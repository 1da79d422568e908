// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/scenario.hpp"

#include <algorithm>

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ScenarioFile : public testing::Test {
 protected:
  ScenarioFile() { folder.write("w.sdf", "<sdf version='1.9'><world name='w'/></sdf>"); }
  Scenario load(const std::string& content) {
    return Scenario::load(folder.write("s.yaml", "name: test\nworld: w.sdf\n" + content));
  }
  std::string error_of(const std::string& content) {
    return test::config_error([&] { load(content); });
  }
  test::TemporaryFolder folder;
};

TEST_F(ScenarioFile, LeavesDefaultsWhereNothingIsSaid) {
  const Scenario scenario = load("");
  EXPECT_EQ(scenario.name, "test");
  EXPECT_EQ(scenario.seed, 1U);
  EXPECT_EQ(scenario.vehicle.model.mass, 0.9);
  EXPECT_EQ(scenario.sensors.imu1.rate_hz, 200.0);
  EXPECT_EQ(scenario.sensors.lidar.beams, 1000);
  EXPECT_TRUE(scenario.mission.waypoints.empty());
  EXPECT_FALSE(scenario.start.z.has_value());
}

TEST_F(ScenarioFile, ReadsEverything) {
  const Scenario scenario = load(R"(
seed: 42
vehicle: {mass: 1.2, inertia: [0.01, 0.011, 0.02], body_radius: 0.3, leg_height: 0.1}
start: {x: 1, y: 2, z: 0.5, yaw: 1.5}
wind: {mean: [1, 0, 0], gust_intensity: [0.5, 0.5, 0.1], gust_time_constant: 3}
sensors:
  imu0: {rate_hz: 500, gyroscope: {bias: 0}, mount: {roll_pitch_yaw: [0, 0, 1.5707963267948966]}}
  phone: {drop_probability: 0.1, latency_ms: 40}
  lidar: {beams: 360}
  battery: {cells: 3}
mission:
  takeoff_altitude: 1.5
  waypoints: [{x: 1, y: 2}, {x: 3, y: 4, z: 2, yaw: -1}]
  return_to_pad: false
obstacles:
  - {name: door, position: [1, 2, 3], size: [1, 0.1, 2], appears_at_s: 5, disappears_at_s: 9}
pushes: [{at_s: 12, duration_s: 0.5, force: [0, 0, -3]}]
claw: {object: true, object_opening: 0.3}
time_limit_s: 60
map: {min: [-1, -2], max: [3, 4], resolution: 0.1}
)");
  EXPECT_EQ(scenario.seed, 42U);
  EXPECT_EQ(scenario.vehicle.model.mass, 1.2);
  EXPECT_EQ(scenario.vehicle.model.inertia, Eigen::Vector3d(0.01, 0.011, 0.02));
  EXPECT_EQ(scenario.vehicle.hull.radius, 0.3);
  EXPECT_EQ(scenario.start.z, 0.5);
  EXPECT_EQ(scenario.wind.gust_intensity.z(), 0.1);
  EXPECT_EQ(scenario.sensors.imu0.rate_hz, 500.0);
  EXPECT_EQ(scenario.sensors.imu0.gyroscope.bias, 0.0);
  EXPECT_GT(scenario.sensors.imu0.gyroscope.noise_density, 0.0);
  const Eigen::Vector3d x_S = scenario.sensors.imu0.mount.attitude * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((x_S - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_EQ(scenario.sensors.phone.latency_ms, 40.0);
  EXPECT_EQ(scenario.sensors.lidar.beams, 360);
  EXPECT_EQ(scenario.sensors.battery.cells, 3);
  ASSERT_EQ(scenario.mission.waypoints.size(), 2U);
  EXPECT_FALSE(scenario.mission.waypoints[0].z.has_value());
  EXPECT_EQ(scenario.mission.waypoints[1].yaw, -1.0);
  EXPECT_FALSE(scenario.mission.return_to_pad);
  EXPECT_TRUE(scenario.mission.land);
  ASSERT_EQ(scenario.obstacles.size(), 1U);
  EXPECT_EQ(scenario.obstacles[0].disappears_at_s, 9.0);
  ASSERT_EQ(scenario.pushes.size(), 1U);
  EXPECT_EQ(scenario.pushes[0].force, Eigen::Vector3d(0, 0, -3));
  EXPECT_EQ(scenario.map.max, Eigen::Vector2d(3, 4));
  ASSERT_TRUE(scenario.claw.has_value());
  EXPECT_TRUE(scenario.claw->object);
  EXPECT_EQ(scenario.claw->object_opening, 0.3);
}

TEST_F(ScenarioFile, AClawIsFlownByTwoComponentsMore) {
  const auto names = components_of(load(""));
  EXPECT_EQ(std::count(names.begin(), names.end(), "claw"), 0);
  const auto with_claw = components_of(load("claw: {}"));
  EXPECT_EQ(with_claw.size(), names.size() + 2);
  EXPECT_EQ(std::count(with_claw.begin(), with_claw.end(), "sim_claw"), 1);
  EXPECT_EQ(std::count(with_claw.begin(), with_claw.end(), "claw"), 1);
}

TEST_F(ScenarioFile, AMissingFileOrWorldIsNamed) {
  EXPECT_THAT(test::config_error([] { Scenario::load("/nowhere/s.yaml"); }),
              AllOf(HasSubstr("/nowhere/s.yaml"), HasSubstr("check the path")));
  const auto file = folder.write("t.yaml", "name: t\nworld: lost.sdf\n");
  EXPECT_THAT(test::config_error([&] { Scenario::load(file); }),
              AllOf(HasSubstr("t.yaml:2"), HasSubstr("lost.sdf"), HasSubstr("relative")));
  const auto empty = folder.write("e.yaml", "name: t\n");
  EXPECT_THAT(test::config_error([&] { Scenario::load(empty); }),
              AllOf(HasSubstr("e.yaml"), HasSubstr("'world' is missing")));
}

TEST_F(ScenarioFile, BadInputIsRefusedWithItsLineAndARemedy) {
  const std::pair<const char*, std::vector<const char*>> cases[] = {
      {"mission: {waypoints: [", {"s.yaml:", "not valid YAML"}},
      {"seed: many", {"s.yaml:3", "'seed' must be a number"}},
      {"seed: 1.5", {"s.yaml:3", "whole number"}},
      {"seed: -1", {"s.yaml:3", "at least 0"}},
      {"vehicle:\n  mass: .nan", {"s.yaml:4", "vehicle", "finite"}},
      {"vehicle:\n  mass: 0", {"s.yaml:4", "positive"}},
      {"vehicle:\n  mass: 50", {"does not lift", "raise it"}},
      {"vehicle:\n  inertia: [1, 2]", {"s.yaml:4", "must have 3 numbers"}},
      {"vehicle: heavy", {"s.yaml:3", "must be a mapping"}},
      {"sensors:\n  lidar:\n    raneg_max: 9", {"s.yaml:5", "'raneg_max'", "'range_max'"}},
      {"sensors:\n  lidar: {range_min: 5, range_max: 2}", {"s.yaml:4", "more than 'range_min'"}},
      {"sensors:\n  imu3: {}", {"s.yaml:4", "'imu3'", "did you mean 'imu"}},
      {"sensors:\n  imu0: {rate_hz: 2000}", {"s.yaml:4", "from 0 to 1000"}},
      {"sensors:\n  phone: {drop_probability: 1.5}", {"s.yaml:4", "from 0 to 1"}},
      {"misson: {}", {"s.yaml:3", "'misson'", "'mission'"}},
      {"mission:\n  waypoints:\n    - {x: 1}", {"s.yaml:5", "waypoints[0]", "'y' is missing"}},
      {"mission:\n  waypoints:\n    - {x: .inf, y: 1}", {"s.yaml:5", "finite"}},
      {"mission:\n  waypoints:\n    - {x: 1, y: 1, zz: 1}", {"s.yaml:5", "'zz'", "'z'"}},
      {"mission: {explore: true, waypoints: [{x: 1, y: 1}]}", {"s.yaml:3", "has no waypoints"}},
      {"mission:\n  waypoints: [1, 2]", {"s.yaml:4", "must be a mapping"}},
      {"obstacles:\n  - {name: a, position: [0, 0, 0], size: [1, -1, 1]}",
       {"s.yaml:4", "positive"}},
      {"obstacles:\n  - {name: a, position: [0, 0, 0]}", {"s.yaml:4", "'size' is missing"}},
      {"obstacles:\n  - {name: a, position: [0, 0, 0], size: [1, 1, 1]}\n"
       "  - {name: a, position: [0, 0, 0], size: [1, 1, 1]}",
       {"s.yaml:5", "already", "differently"}},
      {"pushes: [{at_s: 1, force: [1, 0, 0]}]", {"s.yaml:3", "'duration_s' is missing"}},
      {"map: {min: [0, 0], max: [1, -1]}", {"s.yaml:3", "more than 'min'"}},
      {"map: {min: [0, 0], max: [9999, 9999], resolution: 0.01}", {"s.yaml:3", "coarser"}},
      {"claw: {objekt: true}", {"s.yaml:3", "'objekt'", "'object'"}},
      {"claw: {object: true, start_opening: 0.1}", {"s.yaml:3", "between the jaws"}},
      {"claw: {pulse_open_us: 2000}", {"s.yaml:3", "another than 'pulse_open_us'"}},
      {"time_limit_s: soon", {"s.yaml:3", "'time_limit_s' must be a number"}},
  };
  for (const auto& [content, parts] : cases) {
    const std::string message = error_of(content);
    for (const char* part : parts) EXPECT_THAT(message, HasSubstr(part)) << content;
  }
}

}  // namespace
}  // namespace swiftlet
