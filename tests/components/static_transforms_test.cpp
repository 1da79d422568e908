// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/static_transforms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using Pose = StaticTransforms::Pose;

Pose some_pose(double seed) {
  return {{seed, 0.5 - seed, 0.1 * seed}, exp_so3({0.3 * seed, -0.2, seed})};
}

void expect_same(const std::optional<Pose>& a, const Pose& b) {
  ASSERT_TRUE(a);
  EXPECT_LT((a->position - b.position).norm(), 1e-12);
  EXPECT_LT(a->attitude.angularDistance(b.attitude), 1e-7);
}

TEST(StaticTransforms, AFrameInItselfIsWhereItIs) {
  expect_same(StaticTransforms().find("laser", "laser"), Pose());
}

TEST(StaticTransforms, WhatWasNotToldIsNotKnown) {
  StaticTransforms transforms;
  ASSERT_TRUE(transforms.add(to_transform({}, "base_link", "laser", some_pose(1.0))).ok());
  EXPECT_FALSE(transforms.find("base_link", "sonar"));
  EXPECT_FALSE(transforms.find("laser", "base_link")) << "parents are not looked for in children";
  expect_same(transforms.find("base_link", "laser"), some_pose(1.0));
}

TEST(StaticTransforms, AChainIsTheProductOfItsLinksInWhateverOrderTheyCome) {
  const Pose a = some_pose(1.0);
  const Pose b = some_pose(-0.4);
  StaticTransforms transforms;
  ASSERT_TRUE(transforms.add(to_transform({}, "mast", "laser", b)).ok());
  EXPECT_FALSE(transforms.find("base_link", "laser"));
  ASSERT_TRUE(transforms.add(to_transform({}, "base_link", "mast", a)).ok());
  // The same by matrices.
  Eigen::Isometry3d first = Eigen::Translation3d(a.position) * a.attitude;
  Eigen::Isometry3d second = Eigen::Translation3d(b.position) * b.attitude;
  const Eigen::Isometry3d product = first * second;
  expect_same(transforms.find("base_link", "laser"),
              {product.translation(), Eigen::Quaterniond(product.rotation())});
}

TEST(StaticTransforms, TheLastWordCounts) {
  StaticTransforms transforms;
  ASSERT_TRUE(transforms.add(to_transform({}, "base_link", "laser", some_pose(1.0))).ok());
  ASSERT_TRUE(transforms.add(to_transform({}, "base_link", "laser", some_pose(2.0))).ok());
  expect_same(transforms.find("base_link", "laser"), some_pose(2.0));
}

TEST(StaticTransforms, ARingEnds) {
  StaticTransforms transforms;
  ASSERT_TRUE(transforms.add(to_transform({}, "a", "b", some_pose(1.0))).ok());
  ASSERT_TRUE(transforms.add(to_transform({}, "b", "a", some_pose(1.0))).ok());
  ASSERT_TRUE(transforms.add(to_transform({}, "c", "c", some_pose(1.0))).ok());
  EXPECT_FALSE(transforms.find("base_link", "a"));
  EXPECT_FALSE(transforms.find("base_link", "c"));
}

TEST(StaticTransforms, WhatIsNoPoseIsRefusedAndChangesNothing) {
  StaticTransforms transforms;
  ASSERT_TRUE(transforms.add(to_transform({}, "base_link", "laser", some_pose(1.0))).ok());
  auto message = to_transform({}, "base_link", "laser", some_pose(2.0));
  message.transform().translation().x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(transforms.add(message).ok());
  message = to_transform({}, "base_link", "laser", some_pose(2.0));
  message.transform().rotation({});
  EXPECT_FALSE(transforms.add(message).ok());
  expect_same(transforms.find("base_link", "laser"), some_pose(1.0));
}

TEST(StaticTransforms, MemoryIsBounded) {
  StaticTransforms transforms;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(transforms.add(to_transform({}, "base_link", std::to_string(i), {})).ok());
  }
  EXPECT_FALSE(transforms.add(to_transform({}, "base_link", "one more", {})).ok());
  EXPECT_TRUE(transforms.add(to_transform({}, "base_link", "7", some_pose(1.0))).ok());
}

}  // namespace
}  // namespace swiftlet
