// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace swiftlet {
namespace {

using CubeIndex = std::array<long, 3>;

CubeIndex cube_of(const Eigen::Vector3d& point, double edge) {
  return {std::lround(std::floor(point.x() / edge)), std::lround(std::floor(point.y() / edge)),
          std::lround(std::floor(point.z() / edge))};
}

TEST(VoxelFilter, KeepsTheMeanOfEachCubeWhateverTheOrder) {
  constexpr double kEdge = 0.2;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(number(random), number(random), number(random));
  std::map<CubeIndex, std::pair<Eigen::Vector3d, int>> cubes;
  for (const Eigen::Vector3d& point : points) {
    auto& [sum, count] =
        cubes.try_emplace(cube_of(point, kEdge), Eigen::Vector3d::Zero(), 0).first->second;
    sum += point;
    ++count;
  }
  for (int round = 0; round < 2; ++round) {
    VoxelFilter filter(kEdge);
    for (const Eigen::Vector3d& point : points) ASSERT_TRUE(filter.add(point));
    EXPECT_EQ(filter.size(), cubes.size());
    ASSERT_EQ(filter.points().size(), cubes.size());
    for (const Eigen::Vector3d& kept : filter.points()) {
      const auto cube = cubes.find(cube_of(kept, kEdge));
      ASSERT_NE(cube, cubes.end()) << "the mean lies in its cube";
      EXPECT_LT((kept - cube->second.first / cube->second.second).norm(), 1e-12);
    }
    std::shuffle(points.begin(), points.end(), random);
  }
}

TEST(VoxelFilter, LeavesOutWhatIsNoPlaceAndWhatIsTooFarAway) {
  VoxelFilter filter(0.01);
  EXPECT_FALSE(filter.add({std::nan(""), 0.0, 0.0}));
  EXPECT_FALSE(filter.add({0.0, std::numeric_limits<double>::infinity(), 0.0}));
  EXPECT_FALSE(filter.add({0.0, 0.0, -1e9}));
  EXPECT_EQ(filter.size(), 0u);
  EXPECT_TRUE(filter.add({-1e4, 1e4, 0.0}));
  EXPECT_TRUE(filter.add({-1e4, 1e4, 0.02})) << "another cube, also far out";
  EXPECT_EQ(filter.size(), 2u);
}

}  // namespace
}  // namespace swiftlet
