// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/random_stream.hpp"

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

std::vector<double> draw(std::uint64_t seed, const char* name, int count) {
  RandomStream random(seed, name);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(random.normal());
  return values;
}

TEST(RandomStream, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  const auto values = draw(1, "imu0", 200000);
  double fourth = 0.0;
  int beyond_two = 0;
  for (const double v : values) {
    fourth += v * v * v * v / static_cast<double>(values.size());
    beyond_two += std::abs(v) > 2.0;
  }
  EXPECT_NEAR(test::mean(values), 0.0, 0.01);
  EXPECT_NEAR(test::variance(values), 1.0, 0.015);
  EXPECT_NEAR(fourth, 3.0, 0.1);
  EXPECT_NEAR(beyond_two / 200000.0, 0.0455, 0.002);
}

TEST(RandomStream, DependsOnSeedAndNameAndNothingElse) {
  EXPECT_EQ(draw(7, "imu0", 100), draw(7, "imu0", 100));
  EXPECT_NE(draw(7, "imu0", 1), draw(8, "imu0", 1));
  EXPECT_NE(draw(7, "imu0", 1), draw(7, "imu1", 1));
}

TEST(RandomStream, StreamsOfNeighbouringSeedsAndNamesAreUncorrelated) {
  constexpr int kCount = 50000;
  const auto a = draw(7, "imu0", kCount);
  for (const auto& b : {draw(8, "imu0", kCount), draw(7, "imu1", kCount)}) {
    double product = 0.0;
    for (int i = 0; i < kCount; ++i) product += a[i] * b[i] / kCount;
    EXPECT_NEAR(product, 0.0, 4.0 / std::sqrt(kCount));
  }
}

TEST(RandomStream, UniformNumbersFillTheUnitInterval) {
  RandomStream random(3, "uniform");
  std::vector<int> bins(10, 0);
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++bins[static_cast<std::size_t>(10.0 * u)];
  }
  for (const int count : bins) EXPECT_NEAR(count, 10000, 400);
}

TEST(GaussMarkov, KeepsItsVarianceAndForgetsWithItsTimeConstant) {
  RandomStream random(5, "drift");
  const Eigen::Vector3d sigma(1.0, 2.0, 0.5);
  Eigen::Vector3d state = sigma.cwiseProduct(random.normal3());
  std::vector<double> y;
  for (int i = 0; i < 400000; ++i) {
    state = gauss_markov_step(state, sigma, 1.0, 0.05, random.normal3());
    y.push_back(state.y());
  }
  EXPECT_NEAR(std::sqrt(test::variance(y)), 2.0, 0.08);
  EXPECT_NEAR(test::autocorrelation(y, 20), std::exp(-1.0), 0.04);
}

}  // namespace
}  // namespace swiftlet
