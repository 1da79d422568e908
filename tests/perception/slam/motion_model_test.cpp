// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/motion_model.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swiftlet::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep = 0.1;  // [s]
const Matrix3d kWellSeen = Vector3d(0.005, 0.005, 0.005).cwiseAbs2().cwiseInverse().asDiagonal();

/// The model of a vehicle that has gone 0.6 m/s ahead for two seconds.
MotionModel after_a_straight() {
  MotionModel model{MotionModel::Params{}};
  for (int i = 0; i < 20; ++i) model.update(kStep, {{0.06, 0.0}, 0.0}, kWellSeen);
  return model;
}

TEST(MotionModel, AtFirstAnyMotionIsLikelyInEveryDirection) {
  const auto motion = MotionModel{MotionModel::Params{}}.predict(0.2);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->relative.vector(), Vector3d::Zero());
  EXPECT_GT(motion->covariance(0, 0), 0.09 * 0.09);
  EXPECT_DOUBLE_EQ(motion->covariance(0, 0), motion->covariance(1, 1));
}

TEST(MotionModel, AVehicleGoesOnAsItDid) {
  const MotionModel model = after_a_straight();
  const auto motion = model.predict(0.3);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->relative.position.x(), 0.18, 0.002);
  EXPECT_NEAR(motion->relative.position.y(), 0.0, 1e-9);
  EXPECT_LT(motion->covariance(0, 0), 0.1 * 0.1);
}

TEST(MotionModel, AlongACorridorTheSpeedIsKeptAndBecomesUncertain) {
  MotionModel model = after_a_straight();
  const double at_once = model.predict(kStep)->covariance(0, 0);
  // Only across is anything seen; along, matches say that nothing moved, and that they do not know.
  Matrix3d across = kWellSeen;
  across(0, 0) = 1e-4;
  for (int i = 0; i < 100; ++i) model.update(kStep, {{0.0, 0.0}, 0.0}, across);
  const auto motion = model.predict(kStep);
  EXPECT_NEAR(motion->relative.position.x(), 0.06, 0.003);
  EXPECT_GT(motion->covariance(0, 0), 10.0 * at_once);
  EXPECT_LT(motion->covariance(1, 1), 2.0 * at_once);
}

TEST(MotionModel, WhatIsKnownTurnsWithTheVehicle) {
  MotionModel model = after_a_straight();
  // While it goes on north-east it turns by a quarter, and looks aside then.
  model.update(kStep, {{0.06, 0.0}, 0.12}, kWellSeen);
  const auto motion = model.predict(kStep);
  EXPECT_LT(motion->relative.position.y(), -0.005);
  EXPECT_GT(motion->relative.yaw, 0.03);
}

TEST(MotionModel, MotionsOfTheAccelerationThatItExpectsAreWithinItsSigma) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  const MotionModel::Params params;
  double squares = 0.0;
  constexpr int kRuns = 200, kSteps = 20;
  for (int run = 0; run < kRuns; ++run) {
    MotionModel model(params);
    double speed = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      speed += std::sqrt(kStep) * params.acceleration * normal(random);
      const double moved = kStep * speed;
      const auto motion = model.predict(kStep);
      const double error = moved - motion->relative.position.x();
      if (i > 5) squares += error * error / motion->covariance(0, 0) / kRuns / (kSteps - 6);
      model.update(kStep, {{moved + 0.005 * normal(random), 0.0}, 0.0}, kWellSeen);
    }
  }
  EXPECT_NEAR(squares, 1.0, 0.2);
}

TEST(MotionModel, WhatNoVehicleDoesAndLongGapsEndAllThatWasKnown) {
  const Vector3d nothing = Vector3d::Zero();
  for (const Pose2& jump : {Pose2{{0.5, 0.0}, 0.0}, Pose2{{0.0, 0.0}, 1.0}}) {
    MotionModel model = after_a_straight();
    model.update(kStep, jump, kWellSeen);
    EXPECT_EQ(model.predict(kStep)->relative.vector(), nothing);
  }
  MotionModel model = after_a_straight();
  model.update(5.0, {{0.1, 0.0}, 0.0}, kWellSeen);
  EXPECT_EQ(model.predict(kStep)->relative.vector(), nothing);
  EXPECT_FALSE(model.predict(0.0));
  EXPECT_FALSE(model.predict(5.0));
}

TEST(MotionModel, TwoScansOfOneMomentSayNothing) {
  MotionModel model = after_a_straight();
  const Vector3d before = model.predict(kStep)->relative.vector();
  model.update(0.0, {{0.01, 0.0}, 0.0}, kWellSeen);
  EXPECT_EQ(model.predict(kStep)->relative.vector(), before);
}

}  // namespace
}  // namespace swiftlet::test
