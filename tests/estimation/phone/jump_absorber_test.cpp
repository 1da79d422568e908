// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/phone/jump_absorber.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;
using Pose = JumpAbsorber::Pose;
using Outcome = JumpAbsorber::Outcome;

constexpr Duration kPeriod = 33ms;

/// A vehicle on a circle of 1 m, at 1 m/s and heading along it, and a phone that may be wrong.
class JumpAbsorberTest : public testing::Test {
 protected:
  Pose truth() const {
    const double angle = to_seconds(now_);
    return {{std::cos(angle), std::sin(angle), 1.0}, from_yaw(angle + 0.5 * M_PI)};
  }
  /// Where the phone thinks the vehicle is: turned by `yaw_` about the origin, then moved.
  Pose measured() {
    const Pose pose = truth();
    const Vector3d noise = position_sigma_ * Vector3d(normal_(random_), normal_(random_), 0.0);
    return {from_yaw(yaw_) * pose.position + offset_ + noise,
            from_yaw(yaw_ + attitude_sigma_ * normal_(random_)) * pose.attitude};
  }
  JumpAbsorber::Output step() { return step(measured()); }
  JumpAbsorber::Output step(const Pose& pose) {
    const JumpAbsorber::Measurement measurement{now_, pose, position_sigma_, attitude_sigma_};
    const auto output = absorber_.follow(measurement);
    now_ += kPeriod;
    return output;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(step().outcome, Outcome::kFollowed);
  }

  JumpAbsorber::Params params_;
  JumpAbsorber absorber_{params_};
  Time now_{1s};
  Vector3d offset_ = Vector3d::Zero();
  double yaw_ = 0.0;
  double position_sigma_ = 0.0;
  double attitude_sigma_ = 0.0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(JumpAbsorberTest, WithoutAJumpTheOutputIsTheMeasurement) {
  position_sigma_ = 0.03;
  attitude_sigma_ = 0.2;
  for (int i = 0; i < 10'000; ++i) {
    const Pose pose = measured();
    const auto output = step(pose);
    ASSERT_EQ(output.outcome, Outcome::kFollowed) << i;
    ASSERT_EQ(output.pose.position, pose.position);
    ASSERT_LT(output.pose.attitude.angularDistance(pose.attitude), 1e-7);
  }
}

TEST_F(JumpAbsorberTest, SingleOutliersAreWithheld) {
  run(100);
  for (int i = 0; i < 50; ++i) {
    Pose outlier = measured();
    outlier.position += 3.0 * Vector3d(normal_(random_), normal_(random_), 1.0);
    EXPECT_EQ(step(outlier).outcome, Outcome::kWithheld);
    const Pose pose = measured();
    const auto output = step(pose);
    EXPECT_EQ(output.outcome, Outcome::kFollowed);
    EXPECT_EQ(output.pose.position, pose.position);
  }
}

TEST_F(JumpAbsorberTest, OutliersThatDoNotAgreeAreNoJump) {
  run(100);
  for (int i = 0; i < 8; ++i) {
    Pose outlier = measured();
    outlier.position.z() += i % 2 == 0 ? 4.0 : -4.0;
    EXPECT_EQ(step(outlier).outcome, Outcome::kWithheld);
  }
  EXPECT_EQ(step().outcome, Outcome::kFollowed);
}

/// After a jump: nothing for as long as it takes to be sure, then an output that goes on from where
/// the vehicle is, at the speed of the vehicle and of the following, until it is where the phone
/// is.
TEST_F(JumpAbsorberTest, TheOutputHasNoStepAndEndsWhereThePhoneIs) {
  run(100);
  const Vector3d before = absorber_.last_output()->position;
  const Time time_before = now_ - kPeriod;
  offset_ = {0.9, -0.5, 0.2};
  yaw_ = 0.4;
  for (int i = 0; i + 1 < params_.confirmations; ++i) {
    ASSERT_EQ(step().outcome, Outcome::kWithheld);
  }
  auto output = step();
  ASSERT_EQ(output.outcome, Outcome::kJumped);
  EXPECT_NEAR(output.jump.yaw, 0.4, 0.04) << "but for the turn of one period";

  // Where the vehicle is: it has gone on meanwhile.
  const Pose here = [&] {
    now_ -= kPeriod;
    const Pose pose = truth();
    now_ += kPeriod;
    return pose;
  }();
  const double followed = params_.follow_speed * to_seconds(now_ - time_before);
  EXPECT_LT((output.pose.position - here.position).norm(), followed + 0.01);
  EXPECT_LT(output.pose.attitude.angularDistance(here.attitude), 0.04);
  EXPECT_LT((output.pose.position - before).norm(), 1.05 * to_seconds(now_ - time_before));

  Pose last = output.pose;
  int steps = 0;
  while (absorber_.remaining().norm() > 0.0 || absorber_.remaining_yaw() != 0.0) {
    ASSERT_LT(++steps, 1000) << "never gets there";
    output = step();
    ASSERT_EQ(output.outcome, Outcome::kFollowed);
    const double dt = to_seconds(kPeriod);
    EXPECT_LE((output.pose.position - last.position).norm(),
              (1.0 + params_.follow_speed) * dt + 1e-6);
    EXPECT_LE(output.pose.attitude.angularDistance(last.attitude),
              (1.0 + params_.follow_turn_rate) * dt + 1e-6);
    last = output.pose;
  }
  const Pose pose = measured();
  EXPECT_EQ(step(pose).pose.position, pose.position) << "exactly";
}

TEST_F(JumpAbsorberTest, AStandingVehicleMovesNoFasterThanIsAllowed) {
  const Pose rest{{1.0, 2.0, 1.0}, from_yaw(0.3)};
  for (int i = 0; i < 30; ++i) step(rest);
  const Pose there{{1.0, 3.0, 1.0}, from_yaw(0.3)};
  JumpAbsorber::Output output;
  for (int i = 0; i < params_.confirmations; ++i) output = step(there);
  ASSERT_EQ(output.outcome, Outcome::kJumped);
  EXPECT_LT((output.jump.translation - Vector3d(0.0, 1.0, 0.0)).norm(), 1e-9);
  EXPECT_EQ(output.jump.yaw, 0.0);
  // What has been worked off since the first pose at the new place.
  const double since = to_seconds(kPeriod) * (params_.confirmations - 1);
  EXPECT_NEAR((output.pose.position - rest.position).norm(), params_.follow_speed * since, 1e-9);
  const double seconds = 1.0 / params_.follow_speed;
  const int steps = static_cast<int>(std::ceil((seconds - since) / to_seconds(kPeriod)));
  for (int i = 0; i + 2 < steps; ++i) step(there);
  EXPECT_GT(absorber_.remaining().norm(), 0.0);
  for (int i = 0; i < 3; ++i) output = step(there);
  EXPECT_EQ(output.pose.position, there.position);
}

/// Motion at the greatest speed would lead there while the poses are withheld.
TEST_F(JumpAbsorberTest, ASmallJumpIsStillAJump) {
  run(100);
  offset_ = {0.4, 0.0, 0.0};
  for (int i = 0; i + 1 < params_.confirmations; ++i) {
    ASSERT_EQ(step().outcome, Outcome::kWithheld);
  }
  EXPECT_EQ(step().outcome, Outcome::kJumped);
  yaw_ = 0.5;  // and about where the vehicle is
  offset_ += truth().position - from_yaw(yaw_) * truth().position;
  for (int i = 0; i + 1 < params_.confirmations; ++i) {
    ASSERT_EQ(step().outcome, Outcome::kWithheld);
  }
  EXPECT_EQ(step().outcome, Outcome::kJumped);
}

TEST_F(JumpAbsorberTest, NoiseOfTheHeadingIsNotAbsorbed) {
  position_sigma_ = 0.01;
  attitude_sigma_ = 0.27;  // of the Tango phone, see PhonePoseSensor
  run(100);
  offset_ = {2.0, 0.0, 0.0};
  JumpAbsorber::Output output;
  for (int i = 0; i < params_.confirmations; ++i) output = step();
  ASSERT_EQ(output.outcome, Outcome::kJumped);
  EXPECT_EQ(output.jump.yaw, 0.0);
  EXPECT_EQ(absorber_.remaining_yaw(), 0.0);
}

TEST_F(JumpAbsorberTest, JumpsAddUp) {
  const Vector3d home(1.0, 2.0, 1.0);
  for (int i = 0; i < 30; ++i) step({home, from_yaw(0.0)});
  for (const double x : {2.0, 4.0, 1.0}) {  // and back
    for (int i = 0; i < 6; ++i) step({{x, 2.0, 1.0}, from_yaw(0.0)});
    EXPECT_LT((absorber_.last_output()->position - home).norm(), 0.2);
  }
  for (int i = 0; i < 100; ++i) step({home, from_yaw(0.0)});
  EXPECT_EQ(absorber_.last_output()->position, home);
}

TEST_F(JumpAbsorberTest, AFirstPoseThatNoneAgreesWithIsAFalseStart) {
  Pose outlier = measured();
  outlier.position.x() += 5.0;
  step(outlier);
  JumpAbsorber::Output output;
  for (int i = 0; i < params_.confirmations; ++i) output = step();
  EXPECT_EQ(output.outcome, Outcome::kFalseStart);
}

TEST_F(JumpAbsorberTest, AfterAGapThereIsMoreRoom) {
  run(100);
  now_ += 2s;  // 2 m further on the circle, and another metre
  offset_ = {1.0, 0.0, 0.0};
  EXPECT_EQ(step().outcome, Outcome::kFollowed);
}

}  // namespace
}  // namespace swiftlet
