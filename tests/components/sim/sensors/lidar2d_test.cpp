// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/lidar2d.hpp"

#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

VehicleTruth at(int ms, const Vector3d& p, const Eigen::Quaterniond& q) {
  VehicleTruth truth;
  truth.time = Time(std::chrono::milliseconds(ms));
  truth.body.p_WB = p;
  truth.body.q_WB = q;
  return truth;
}

/// A room of 8 m x 6 m about the origin, walls towards +x, -x, +y, -y.
World room() {
  World world = test::flat_world();
  const double sides[4][4] = {{4.5, 0, 1, 7}, {-4.5, 0, 1, 7}, {0, 3.5, 9, 1}, {0, -3.5, 9, 1}};
  for (const auto& [x, y, size_x, size_y] : sides) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << x, y, 5.0;
    world.add_box("wall", T, {size_x, size_y, 10.0});
  }
  return world;
}

Lidar2d::Params perfect() {
  Lidar2d::Params params;
  params.noise_stddev = params.resolution = params.dropout_probability = 0.0;
  params.mount = {};
  return params;
}

TEST(Lidar2d, MeasuresARectangularRoom) {
  const World world = room();
  Lidar2d lidar(perfect(), RandomStream(1, "lidar"));
  const double yaw = 0.4;
  const Vector3d p(1.0, -0.5, 1.2);
  const LaserScanReading* scan = lidar.update(at(100, p, from_yaw(yaw)), world);
  ASSERT_NE(scan, nullptr);
  ASSERT_EQ(scan->ranges.size(), 1000U);
  EXPECT_NEAR(scan->angle_increment * 1000.0, 2.0 * M_PI, 1e-12);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double angle = yaw + scan->angle_min + static_cast<double>(i) * scan->angle_increment;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double to_x = (c > 0.0 ? 4.0 - p.x() : -4.0 - p.x()) / c;
    const double to_y = (s > 0.0 ? 3.0 - p.y() : -3.0 - p.y()) / s;
    ASSERT_NEAR(scan->ranges[i], std::min(to_x, to_y), 1e-4) << i;
  }
}

TEST(Lidar2d, TiltMakesItSeeTheFloor) {
  const World world = test::flat_world();
  Lidar2d lidar(perfect(), RandomStream(1, "lidar"));
  const double pitch = 0.2;  // nose down
  const auto q = Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Vector3d::UnitY()));
  const LaserScanReading* scan = lidar.update(at(100, {0, 0, 1.2}, q), world);
  EXPECT_NEAR(scan->ranges[500], 1.2 / std::sin(pitch), 1e-4);  // ahead
  EXPECT_TRUE(std::isinf(scan->ranges[0]));                     // behind: the sky
}

TEST(Lidar2d, SaysWhetherABeamIsTooNearOrWithoutReturn) {
  World world = room();
  Lidar2d::Params params = perfect();
  params.range_max = 3.5;
  Lidar2d lidar(params, RandomStream(1, "lidar"));
  const LaserScanReading* scan = lidar.update(at(100, {0, 2.9, 1.2}, from_yaw(0.0)), world);
  EXPECT_EQ(scan->ranges[500], std::numeric_limits<float>::infinity());   // +x, 4 m
  EXPECT_EQ(scan->ranges[750], -std::numeric_limits<float>::infinity());  // +y, 0.1 m
}

TEST(Lidar2d, NoiseDropoutsAndResolutionAreAsAsked) {
  const World world = room();
  Lidar2d::Params params = perfect();
  params.noise_stddev = 0.02;
  params.dropout_probability = 0.05;
  Lidar2d noisy(params, RandomStream(2, "lidar"));
  Lidar2d exact(perfect(), RandomStream(2, "lidar"));
  std::vector<double> errors;
  int dropped = 0;
  for (int ms = 100; ms <= 5000; ms += 100) {
    const VehicleTruth truth = at(ms, {0, 0, 1.2}, from_yaw(0.1));
    const auto ranges = noisy.update(truth, world)->ranges;
    const auto& truths = exact.update(truth, world)->ranges;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      ASSERT_FALSE(std::isnan(ranges[i]));
      if (std::isinf(ranges[i]))
        ++dropped;
      else
        errors.push_back(ranges[i] - truths[i]);
    }
  }
  EXPECT_NEAR(dropped / 50000.0, 0.05, 0.005);
  EXPECT_NEAR(std::sqrt(test::variance(errors)), 0.02, 0.0005);
  EXPECT_NEAR(test::mean(errors), 0.0, 0.0005);

  params = perfect();
  params.resolution = 0.1;
  Lidar2d coarse(params, RandomStream(2, "lidar"));
  for (const float range : coarse.update(at(100, {0, 0, 1.2}, from_yaw(0.1)), world)->ranges) {
    EXPECT_NEAR(10.0 * range, std::round(10.0 * range), 1e-4);
  }
}

TEST(Lidar2d, TurnsAtItsRate) {
  const World world;
  Lidar2d lidar(perfect(), RandomStream(1, "lidar"));
  int count = 0;
  for (int ms = 1; ms <= 10000; ++ms) {
    count += lidar.update(at(ms, {0, 0, 1}, from_yaw(0.0)), world) != nullptr;
  }
  EXPECT_EQ(count, 100);
}

}  // namespace
}  // namespace swiftlet
