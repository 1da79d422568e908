// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/ukf/delayed_ukf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <utility>

#include "tests/estimation/ukf/imu_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using Outcome = UpdateReport::Outcome;
using ::testing::HasSubstr;

constexpr double kDt = 0.005;
constexpr int kEvery = 7;  // IMU samples a pose
const Matrix6d kCovariance = pose_covariance(0.02, 0.01);

void expect_same(const PoseImuUkf& a, const PoseImuUkf& b) {
  EXPECT_EQ(a.time(), b.time());
  EXPECT_EQ(a.state().p_WB, b.state().p_WB);
  EXPECT_EQ(a.state().v_WB_W, b.state().v_WB_W);
  EXPECT_EQ(a.state().q_WB.coeffs(), b.state().q_WB.coeffs());
  EXPECT_EQ(a.covariance(), b.covariance());
}

/// A flight of `samples` IMU samples through a filter that hears of poses `delay` samples late, and
/// through one that hears of them at once.
std::pair<DelayedUkf, PoseImuUkf> fly_both(int samples, int delay) {
  const Motion motion;
  const Biases biases{{0.1, -0.1, 0.05}, {0.01, 0.0, -0.01}, Vector3d::Zero()};
  Noise noise(3);
  DelayedUkf late({});
  PoseImuUkf prompt;
  const PoseMeasurement first = measure(motion, 0, kCovariance, &noise);
  EXPECT_TRUE(late.initialize(at(0), first));
  EXPECT_TRUE(prompt.initialize(at(0), first));
  std::deque<std::pair<int, PoseMeasurement>> on_the_way;
  for (int k = 0; k <= samples; ++k) {
    const ImuSample imu = noisy(motion.imu(k * kDt), {}, kDt, biases, noise);
    EXPECT_TRUE(late.predict(at(k * kDt), imu));
    EXPECT_TRUE(prompt.predict(at(k * kDt), imu));
    // The last ones arrive before the end.
    if (k % kEvery == 0 && k + delay <= samples) {
      const PoseMeasurement z = measure(motion, k * kDt, kCovariance, &noise);
      EXPECT_EQ(prompt.update(at(k * kDt), z).outcome, Outcome::kUsed);
      on_the_way.emplace_back(k, z);
    }
    if (!on_the_way.empty() && on_the_way.front().first + delay == k) {
      EXPECT_EQ(late.update(at((k - delay) * kDt), on_the_way.front().second).outcome,
                Outcome::kUsed);
      on_the_way.pop_front();
    }
  }
  return {late, prompt};
}

TEST(DelayedUkf, WithoutDelayItIsThePlainFilter) {
  const auto [late, prompt] = fly_both(500, 0);
  expect_same(late.present(), prompt);
}

TEST(DelayedUkf, LatePosesGiveWhatTheyWouldHaveGivenInTime) {
  for (const int delay : {1, 6, 20, 39}) {  // 5 to 195 ms
    const auto [late, prompt] = fly_both(500, delay);
    expect_same(late.present(), prompt);
  }
}

/// Root mean square of the position error at the present, with poses that are `delay_s` late and
/// not in step with the IMU.
double position_rmse(double delay_s, double counted_delay_s) {
  const Motion motion;
  Noise noise(5);
  DelayedUkf filter({});
  EXPECT_TRUE(filter.initialize(at(0), measure(motion, 0, kCovariance, &noise)));
  double next_pose = 0.0313, sum = 0.0;
  int count = 0;
  for (int k = 1; k <= 4000; ++k) {
    const double t = k * kDt;
    EXPECT_TRUE(filter.predict(at(t), noisy(motion.imu(t), {}, kDt, {}, noise)));
    for (; next_pose + delay_s <= t; next_pose += 0.0313) {
      const PoseMeasurement z = measure(motion, next_pose, kCovariance, &noise);
      filter.update(at(next_pose + delay_s - counted_delay_s), z);
    }
    if (t < 4.0) continue;
    sum += (filter.present().state().p_WB - motion.position(t)).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(DelayedUkf, ATenthOfASecondOfDelayCostsLittle) {
  const double prompt = position_rmse(0.0, 0.0);
  const double late = position_rmse(0.1, 0.1);
  const double taken_as_current = position_rmse(0.1, 0.0);
  EXPECT_LT(late, 1.4 * prompt);
  // At up to 1.3 m/s a tenth of a second is centimetres.
  EXPECT_GT(taken_as_current, 4.0 * late);
}

TEST(DelayedUkf, WhatIsTooOldOrOutOfOrderIsRefused) {
  auto filter = fly_both(500, 0).first;  // the last pose at sample 497
  const Motion motion;
  const PoseMeasurement z = measure(motion, 2.4, kCovariance);
  EXPECT_EQ(filter.update(at(2.4), z).outcome, Outcome::kRefused);
  EXPECT_THAT(filter.update(at(2.4), z).reason, HasSubstr("older than the last"));
  for (int k = 501; k <= 600; ++k) {
    ASSERT_TRUE(filter.predict(at(k * kDt), motion.imu(k * kDt)));
  }
  const PoseImuUkf before = filter.present();
  EXPECT_EQ(filter.update(at(2.79), measure(motion, 2.79, kCovariance)).outcome, Outcome::kRefused);
  EXPECT_EQ(filter.update(Time::min(), z).outcome, Outcome::kRefused);
  EXPECT_EQ(filter.update(Time::max(), z).outcome, Outcome::kRefused);
  expect_same(filter.present(), before);
  EXPECT_EQ(filter.update(at(2.81), measure(motion, 2.81, kCovariance)).outcome, Outcome::kUsed);
}

TEST(DelayedUkf, ARejectedPoseChangesNothing) {
  auto filter = fly_both(500, 0).first;
  const PoseImuUkf before = filter.present();
  PoseMeasurement z = measure(Motion(), 2.497, kCovariance);
  z.p_WB.x() += 1.0;
  EXPECT_EQ(filter.update(at(2.497), z).outcome, Outcome::kRejected);
  expect_same(filter.present(), before);
}

TEST(DelayedUkf, AfterAGapOfTheImuALatePoseRestartsIt) {
  auto filter = fly_both(500, 0).first;
  const Motion motion;
  constexpr int kDelay = 24;  // 120 ms, more than one step of prediction bridges
  int restarts = 0, refused = 0;
  // One stamp from the far future must not hold up what follows.
  EXPECT_FALSE(filter.predict(Time::max(), motion.imu(0)));
  for (int k = 800; k <= 1200; ++k) {
    refused += filter.predict(at(k * kDt), motion.imu(k * kDt)).ok() ? 0 : 1;
    if (k % kEvery != 0) continue;
    const double t = (k - kDelay) * kDt;
    const Outcome outcome = filter.update(at(t), measure(motion, t, kCovariance)).outcome;
    restarts += outcome == Outcome::kReinitialized ? 1 : 0;
    if (restarts > 0) {
      EXPECT_NE(outcome, Outcome::kRefused);
      EXPECT_NE(outcome, Outcome::kRejected);
      EXPECT_EQ(filter.present().time(), at(k * kDt));
    }
  }
  EXPECT_EQ(restarts, 1);
  EXPECT_LT(refused, 130);
  EXPECT_LT((filter.present().state().p_WB - motion.position(6.0)).norm(), 0.05);
}

TEST(DelayedUkf, ASecondOnTheImuAloneIsAsGoodAsTheCovarianceSays) {
  const Motion motion;
  double nees = 0.0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(static_cast<unsigned long>(200 + run));
    Biases biases;
    biases.accelerometer = PoseImuUkf::Params{}.initial_accelerometer_bias_sigma * noise.vector();
    biases.gyroscope = PoseImuUkf::Params{}.initial_gyro_bias_sigma * noise.vector();
    DelayedUkf filter({});
    ASSERT_TRUE(filter.initialize(at(0), measure(motion, 0, kCovariance, &noise)));
    for (int k = 0; k <= 800; ++k) {
      biases.accelerometer +=
          PoseImuUkf::Params{}.bias_random_walk * std::sqrt(kDt) * noise.vector();
      biases.gyroscope +=
          PoseImuUkf::Params{}.gyro_bias_random_walk * std::sqrt(kDt) * noise.vector();
      ASSERT_TRUE(filter.predict(at(k * kDt), noisy(motion.imu(k * kDt), {}, kDt, biases, noise)));
      if (k % kEvery != 0 || k > 600) continue;
      filter.update(at(k * kDt), measure(motion, k * kDt, kCovariance, &noise));
    }
    ASSERT_EQ(filter.present().time(), at(4.0));
    const auto error = error_of(filter.present(), motion, 4.0, biases).head<15>().eval();
    nees += error.dot(filter.present().covariance().topLeftCorner<15, 15>().ldlt().solve(error));
  }
  // 15 kRuns degrees of freedom: 95 % lie within 1.96 sqrt(2 / (15 kRuns)) of one a degree.
  const double band = 1.96 * std::sqrt(2.0 / (15.0 * kRuns));
  EXPECT_NEAR(nees / (15.0 * kRuns), 1.0, band);
}

TEST(DelayedUkf, UnusableParametersThrow) {
  DelayedUkf::Params params;
  params.max_delay = 0.0;
  EXPECT_THROW(DelayedUkf{params}, std::invalid_argument);
}

}  // namespace
}  // namespace swiftlet::test
