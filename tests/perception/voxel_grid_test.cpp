// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/perception/random_voxels.hpp"

namespace swiftlet {
namespace {

using test::random_voxel;
using test::random_voxels;

/// Points on a lattice of an eighth of a voxel: touching is decided in whole numbers.
constexpr int kLattice = 8;
using Point = std::array<std::int64_t, 3>;  // [eighths]

Eigen::Vector3d to_voxels(const Point& p) {
  return Eigen::Matrix<std::int64_t, 3, 1>(p[0], p[1], p[2]).cast<double>() / kLattice;
}

/// Whether the segment and the closed cube have a point in common: no axis separates them.
bool touch(const Point& a, const Point& b, Voxel voxel) {
  const std::array<std::int64_t, 3> corner{voxel.x, voxel.y, voxel.z};
  Point middle{}, half{};  // twice as large as they are, and so is the cube below
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = a[i] + b[i] - (2 * corner[i] + 1) * kLattice;
    half[i] = b[i] - a[i];
    if (std::abs(middle[i]) > kLattice + std::abs(half[i])) return false;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (std::abs(middle[j] * half[k] - middle[k] * half[j]) >
        kLattice * (std::abs(half[j]) + std::abs(half[k]))) {
      return false;
    }
  }
  return true;
}

bool oracle(const VoxelGrid& grid, const Point& a, const Point& b) {
  for (int z = -1; z <= grid.size_z(); ++z) {
    for (int y = -1; y <= grid.size_y(); ++y) {
      for (int x = -1; x <= grid.size_x(); ++x) {
        if (grid.blocked(Voxel{x, y, z}) && touch(a, b, {x, y, z})) return false;
      }
    }
  }
  return true;
}

TEST(VoxelGrid, ALineIsFreeExactlyWhereItTouchesNothing) {
  std::mt19937 random(1);
  int free = 0;
  constexpr int kTrials = 40'000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const VoxelGrid grid = random_voxels(random, {6, 5, 4}, 0.06);
    const auto point = [&](int step) {
      const auto along = [&](int size) {
        const int last = size * kLattice / step;
        return step * std::uniform_int_distribution<std::int64_t>(0, last)(random);
      };
      return Point{along(6), along(5), along(4)};
    };
    // Coarse ends make lines along borders and through corners frequent.
    const int step = 1 << std::uniform_int_distribution<>(0, 3)(random);
    const Point a = point(step), b = point(step);
    const bool expected = oracle(grid, a, b);
    free += expected ? 1 : 0;
    ASSERT_EQ(line_is_free(grid, to_voxels(a), to_voxels(b)), expected)
        << to_voxels(a).transpose() << " to " << to_voxels(b).transpose();
  }
  EXPECT_GT(free, kTrials / 20);
  EXPECT_LT(free, kTrials - kTrials / 20);
}

TEST(VoxelGrid, AMiddleSeesAnotherExactlyWhereTheLineTouchesNothing) {
  std::mt19937 random(2);
  int free = 0;
  constexpr int kTrials = 40'000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const VoxelGrid grid = random_voxels(random, {7, 6, trial % 2 == 0 ? 1 : 5}, 0.06);
    const Voxel from = random_voxel(random, grid), to = random_voxel(random, grid);
    const auto middle = [](Voxel v) {
      const auto along = [](int i) { return std::int64_t{kLattice} * i + kLattice / 2; };
      return Point{along(v.x), along(v.y), along(v.z)};
    };
    const bool expected = oracle(grid, middle(from), middle(to));
    free += expected ? 1 : 0;
    ASSERT_EQ(sees(grid, from, to), expected);
    ASSERT_EQ(sees(grid, to, from), expected);
    ASSERT_EQ(line_is_free(grid, center_of(from), center_of(to)), expected);
  }
  EXPECT_GT(free, kTrials / 10);
}

TEST(VoxelGrid, WhatIsOutsideOrNoNumberIsNotFree) {
  const VoxelGrid grid = VoxelGrid::make(4, 4, 4).value();
  const Eigen::Vector3d inside(2.0, 2.0, 2.0);
  EXPECT_TRUE(line_is_free(grid, inside, {3.9, 3.9, 3.9}));
  EXPECT_FALSE(line_is_free(grid, inside, {4.0, 2.0, 2.0}));  // touches the outside
  EXPECT_FALSE(line_is_free(grid, inside, {1e300, 2.0, 2.0}));
  EXPECT_FALSE(line_is_free(grid, {-1.0, 2.0, 2.0}, inside));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(line_is_free(grid, inside, {2.0, nan, 2.0}));
  EXPECT_FALSE(line_is_free(grid, {nan, nan, nan}, inside));
}

TEST(VoxelGrid, GrownIsBlockedExactlyWhereABallTouches) {
  std::mt19937 random(3);
  for (const double radius : {0.0, 0.5, 1.0, 1.5, 2.3, 3.0}) {
    const VoxelGrid grid = random_voxels(random, {17, 15, 13}, 0.01);
    const VoxelGrid grown = grid.grown(radius);
    const auto gap = [](int a, int b) { return std::max(0, std::abs(a - b) - 1); };
    for (std::size_t i = 0; i < grid.stored(); ++i) {
      const Voxel here = grid.voxel_at(i);
      bool expected = false;
      for (std::size_t k = 0; k < grid.stored() && !expected; ++k) {
        if (!grid.blocked(k)) continue;
        const Voxel there = grid.voxel_at(k);
        expected =
            std::hypot(gap(here.x, there.x), gap(here.y, there.y), gap(here.z, there.z)) <= radius;
      }
      ASSERT_EQ(grown.blocked(i), expected) << radius;
    }
  }
}

TEST(VoxelGrid, IndicesAndVoxelsAreTheSamePlaces) {
  const VoxelGrid grid = VoxelGrid::make(5, 4, 3).value();
  for (int z = -1; z <= 3; ++z) {
    for (int y = -1; y <= 4; ++y) {
      for (int x = -1; x <= 5; ++x) {
        EXPECT_EQ(grid.voxel_at(grid.index({x, y, z})), (Voxel{x, y, z}));
        EXPECT_EQ(grid.blocked(Voxel{x, y, z}), !grid.contains({x, y, z}));
      }
    }
  }
}

TEST(VoxelGrid, SizesThatCannotBeAreRefused) {
  EXPECT_THAT(VoxelGrid::make(0, 4, 4).error().reason, testing::HasSubstr("0 x 4 x 4"));
  EXPECT_THAT(VoxelGrid::make(2'000'000'000, 2'000'000'000, 1).error().reason,
              testing::HasSubstr("more than"));
}

}  // namespace
}  // namespace swiftlet
