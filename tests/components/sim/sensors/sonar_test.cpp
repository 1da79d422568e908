// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/sonar.hpp"

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

VehicleTruth at(int ms, double x, double height, double roll = 0.0) {
  VehicleTruth truth;
  truth.time = Time(std::chrono::milliseconds(ms));
  truth.body.p_WB << x, 0.0, height;
  truth.body.q_WB = Eigen::AngleAxisd(roll, Vector3d::UnitX());
  return truth;
}

Sonar::Params perfect() {
  Sonar::Params params;
  params.noise_stddev = params.resolution = 0.0;
  params.mount = {};
  return params;
}

TEST(Sonar, MeasuresTheHeightAndKeepsItWhileTheFootOfThePerpendicularIsInTheCone) {
  const World world = test::flat_world();
  Sonar sonar(perfect(), RandomStream(1, "sonar"));
  EXPECT_NEAR(sonar.update(at(50, 0, 2.0), world)->range, 2.0, 1e-5);
  EXPECT_NEAR(sonar.update(at(100, 0, 2.0, 0.2), world)->range, 2.0, 0.005);
  // Beyond the cone only its edge is left.
  EXPECT_NEAR(sonar.update(at(150, 0, 2.0, 0.5), world)->range, 2.0 / std::cos(0.24), 0.02);
}

TEST(Sonar, SeesTheEdgeOfADeskBesideIt) {
  World world = test::flat_world();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 1.0, 0.0, 0.35;
  world.add_box("desk", T, {1.0, 2.0, 0.7});  // from x = 0.5
  Sonar sonar(perfect(), RandomStream(1, "sonar"));
  EXPECT_NEAR(sonar.update(at(50, 0.35, 1.7), world)->range, 1.0, 0.05);
  EXPECT_NEAR(sonar.update(at(100, -0.5, 1.7), world)->range, 1.7, 1e-5);
}

TEST(Sonar, ReadsItsLimitsWhereItIsTooNearOrTooFar) {
  const World world = test::flat_world();
  Sonar sonar(perfect(), RandomStream(1, "sonar"));
  EXPECT_EQ(sonar.update(at(50, 0, 0.05), world)->range, 0.15);
  EXPECT_TRUE(std::isinf(sonar.update(at(100, 0, 7.0), world)->range));
}

TEST(Sonar, RoundsToTheInchWithItsNoiseAtItsRate) {
  const World world = test::flat_world();
  Sonar sonar({}, RandomStream(2, "sonar"));
  std::vector<double> ranges;
  for (int ms = 1; ms <= 100000; ++ms) {
    const RangeReading* reading = sonar.update(at(ms, 0, 1.0), world);
    if (reading == nullptr) continue;
    ranges.push_back(reading->range);
    EXPECT_NEAR(reading->range / 0.0254, std::round(reading->range / 0.0254), 1e-9);
  }
  EXPECT_EQ(ranges.size(), 2000U);
  EXPECT_NEAR(test::mean(ranges), 1.0 - 0.05, 0.003);
  // Noise and a rounding error of up to half an inch.
  EXPECT_NEAR(std::sqrt(test::variance(ranges)), std::hypot(0.01, 0.0254 / std::sqrt(12.0)), 0.002);
}

}  // namespace
}  // namespace swiftlet
