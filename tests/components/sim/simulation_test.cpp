// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/simulation.hpp"

#include <cstring>

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector4d;
using testing::AllOf;
using testing::HasSubstr;

Scenario office() {
  return Scenario::load(std::filesystem::path(SWIFTLET_SOURCE_DIR) /
                        "components/sim/scenarios/office.yaml");
}

/// Every number of every reading, in the order of arrival.
struct Recording {
  std::vector<double> imu[3];
  std::vector<double> phone, scan, range, battery, truth;
  std::vector<double> all() const {
    std::vector<double> numbers;
    for (const auto* part : {&imu[0], &imu[1], &imu[2], &phone, &scan, &range, &battery, &truth}) {
      numbers.insert(numbers.end(), part->begin(), part->end());
    }
    return numbers;
  }
};

/// Hops: thrust a little above hover with a slow wobble.
Recording fly(const Scenario& scenario, double seconds) {
  Simulation simulation(scenario);
  Recording r;
  const auto add = [](std::vector<double>& to, const auto& vector) {
    for (int i = 0; i < vector.size(); ++i) to.push_back(vector[i]);
  };
  const double hover = scenario.vehicle.model.mass * kGravity / 4.0;
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
    const double thrust = hover * (1.02 + 0.05 * std::sin(0.01 * i));
    const SensorReadings readings =
        simulation.step(Simulation::kStep, Vector4d(thrust, 1.001 * thrust, thrust, thrust));
    for (int k = 0; k < 3; ++k) {
      if (readings.imu[k] == nullptr) continue;
      add(r.imu[k], readings.imu[k]->sample.angular_velocity);
      add(r.imu[k], readings.imu[k]->sample.specific_force);
    }
    if (readings.phone) add(r.phone, readings.phone->position);
    if (readings.phone) add(r.phone, readings.phone->attitude.coeffs());
    if (readings.scan)
      add(r.scan,
          Eigen::Map<const Eigen::VectorXf>(readings.scan->ranges.data(),
                                            static_cast<int>(readings.scan->ranges.size())));
    if (readings.range_down) r.range.push_back(readings.range_down->range);
    if (readings.battery) r.battery.push_back(readings.battery->voltage);
    add(r.truth, simulation.truth().body.p_WB);
    add(r.truth, simulation.truth().body.q_WB.coeffs());
  }
  return r;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

TEST(Simulation, SensorsComeAtTheirRatesOverTenSeconds) {
  Scenario scenario = office();
  const Recording r = fly(scenario, 10.0);
  EXPECT_EQ(r.imu[0].size(), 6U * 10000);
  EXPECT_EQ(r.imu[1].size(), 6U * 2000);
  EXPECT_EQ(r.imu[2].size(), 6U * 200);
  EXPECT_EQ(r.phone.size(), 7U * 300);
  EXPECT_EQ(r.scan.size(), 1000U * 100);
  EXPECT_EQ(r.range.size(), 200U);
  EXPECT_EQ(r.battery.size(), 250U);
  for (const double number : r.all()) ASSERT_FALSE(std::isnan(number));
}

TEST(Simulation, TheSameSeedGivesTheSameBitsAndAnotherSeedDoesNot) {
  Scenario scenario = office();
  scenario.wind.gust_intensity.setConstant(0.3);
  const Recording first = fly(scenario, 3.0);
  EXPECT_TRUE(same_bits(first.all(), fly(scenario, 3.0).all()));
  scenario.seed = 2;
  const Recording other = fly(scenario, 3.0);
  EXPECT_FALSE(same_bits(first.imu[0], other.imu[0]));
  EXPECT_FALSE(same_bits(first.phone, other.phone));
  EXPECT_FALSE(same_bits(first.scan, other.scan));
  EXPECT_FALSE(same_bits(first.truth, other.truth));  // other gusts
}

TEST(Simulation, ASensorDoesNotChangeWhatTheOthersSee) {
  Scenario scenario = office();
  const Recording all = fly(scenario, 2.0);
  scenario.sensors.imu1.rate_hz = 0.0;
  scenario.sensors.lidar.rate_hz = 0.0;
  scenario.sensors.phone.rate_hz = 50.0;
  const Recording some = fly(scenario, 2.0);
  EXPECT_TRUE(some.imu[1].empty());
  EXPECT_TRUE(some.scan.empty());
  EXPECT_TRUE(same_bits(all.imu[0], some.imu[0]));
  EXPECT_TRUE(same_bits(all.imu[2], some.imu[2]));
  EXPECT_TRUE(same_bits(all.range, some.range));
  EXPECT_TRUE(same_bits(all.battery, some.battery));
  EXPECT_TRUE(same_bits(all.truth, some.truth));
}

TEST(Simulation, EqualSensorsErrDifferently) {
  Scenario scenario = office();
  scenario.sensors.imu1 = scenario.sensors.imu2 = scenario.sensors.imu0;
  const Recording r = fly(scenario, 0.1);
  ASSERT_EQ(r.imu[0].size(), r.imu[1].size());
  EXPECT_FALSE(same_bits(r.imu[0], r.imu[1]));
  EXPECT_FALSE(same_bits(r.imu[1], r.imu[2]));
  EXPECT_FALSE(same_bits(r.imu[2], r.imu[0]));
}

TEST(Simulation, SensorsReadWhatTheTruthSays) {
  Scenario scenario = office();
  Simulation simulation(scenario);
  const ImuReading* imu = nullptr;
  for (int i = 0; i < 1000; ++i) {
    const auto readings = simulation.step(Simulation::kStep, Vector4d::Zero());
    if (readings.imu[0]) imu = readings.imu[0];
    if (readings.phone) {
      EXPECT_NEAR((readings.phone->position - simulation.truth().body.p_WB).norm(), 0.0, 0.25);
    }
    if (readings.scan) {
      // Nose to the east, pad at x = 0.9: the corridor is free for the 11.95 m to its end.
      EXPECT_NEAR(readings.scan->ranges[500], 11.95, 0.1);
      EXPECT_NEAR(readings.scan->ranges[750], 0.9, 0.1);  // north: the corridor wall at 1.95
      EXPECT_NEAR(readings.scan->ranges[250], 0.9, 0.1);  // south: the outer wall at 0.15
      EXPECT_NEAR(readings.scan->ranges[0], 0.75, 0.1);   // west
    }
  }
  ASSERT_NE(imu, nullptr);
  EXPECT_NEAR(imu->sample.specific_force.z(), kGravity, 0.5);
}

TEST(Simulation, ObstaclesComeAndGoAtTheirTimes) {
  Scenario scenario = office();
  Scenario::Obstacle door;
  door.name = "door";
  door.position << 3.0, 1.05, 1.0;
  door.size << 0.1, 1.8, 2.0;
  door.appears_at_s = 0.5;
  door.disappears_at_s = 1.0;
  scenario.obstacles.push_back(door);
  Simulation simulation(scenario);
  const auto range_ahead = [&] {
    return simulation.world().cast_ray({0.9, 1.05, 1.0}, Eigen::Vector3d::UnitX(), 20.0)->range;
  };
  const auto run_until_ms = [&](int ms) {
    while (simulation.time() < Time(std::chrono::milliseconds(ms))) {
      simulation.step(Simulation::kStep, Vector4d::Zero());
    }
  };
  run_until_ms(499);
  EXPECT_NEAR(range_ahead(), 11.95, 1e-4);
  run_until_ms(520);
  EXPECT_NEAR(range_ahead(), 2.05, 1e-4);
  run_until_ms(1020);
  EXPECT_NEAR(range_ahead(), 11.95, 1e-4);
}

TEST(Simulation, APushChangesTheMomentumByItsImpulse) {
  Scenario scenario = office();
  scenario.start.z = 1.5;
  scenario.vehicle.linear_drag = scenario.vehicle.quadratic_drag = 0.0;
  scenario.wind = {};
  Scenario pushed = scenario;
  pushed.pushes = {{0.05, 0.1, {0.4, 0, 0}}, {0.1, 0.1, {0, 0, -0.6}}};
  Simulation free(scenario), simulation(pushed);
  for (int i = 0; i < 300; ++i) {
    free.step(Simulation::kStep, Vector4d::Zero());
    simulation.step(Simulation::kStep, Vector4d::Zero());
    if (i < 50) {
      EXPECT_EQ(simulation.truth().body.v_WB_W, free.truth().body.v_WB_W);
    }
  }
  const Eigen::Vector3d gained = simulation.truth().body.v_WB_W - free.truth().body.v_WB_W;
  EXPECT_LT((scenario.vehicle.model.mass * gained - Eigen::Vector3d(0.04, 0, -0.06)).norm(), 1e-9);
}

TEST(Simulation, FlyingIntoTheWallIsReported) {
  Scenario scenario = office();
  Simulation simulation(scenario);
  const double hover = scenario.vehicle.model.mass * kGravity / 4.0;
  for (int i = 0; i < 4000; ++i) {
    const double roll = i > 300 && i < 400 ? 0.02 : 0.0;  // leans to the south
    simulation.step(Simulation::kStep,
                    Vector4d::Constant(1.05 * hover) + roll * Vector4d(0, -1, 0, 1));
  }
  ASSERT_GE(simulation.contacts(), 1);
  EXPECT_EQ(simulation.collisions().front().model, "outer_walls");
  EXPECT_LT(simulation.min_clearance(), 0.0);
}

TEST(Simulation, AStartInsideOfSomethingIsRefused) {
  Scenario scenario = office();
  scenario.start.y = 0.2;
  EXPECT_THAT(test::config_error([&] { Simulation{scenario}; }),
              AllOf(HasSubstr("office"), HasSubstr("outer_walls"), HasSubstr("start")));
  scenario = office();
  scenario.world = "/nowhere.sdf";
  EXPECT_THAT(test::config_error([&] { Simulation{scenario}; }), HasSubstr("/nowhere.sdf"));
}

}  // namespace
}  // namespace swiftlet
