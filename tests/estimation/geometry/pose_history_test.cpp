// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geometry/pose_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using namespace std::chrono_literals;

Time at_ms(int ms) {
  return Time(std::chrono::milliseconds(ms));
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return log_so3((a.conjugate() * b).normalized()).norm();
}

TEST(PoseHistory, IsExactForAScrewWhateverTheSamplingTimes) {
  // Straight at constant speed, turning at constant rate: what linear and slerp reproduce.
  const Vector3d speed(1.0, -0.5, 0.2), rate(0.3, -0.8, 1.1);
  const auto screw = [&](Time t) {
    return PoseHistory::Pose{speed * to_seconds(t), exp_so3(rate * to_seconds(t))};
  };
  std::mt19937 random(5);
  PoseHistory history(60s);
  for (int ms = 0; ms < 3000; ms += 1 + static_cast<int>(random() % 200)) {
    // A filter may hand out either sign of the quaternion.
    PoseHistory::Pose pose = screw(at_ms(ms));
    if (random() % 2 == 0) pose.attitude.coeffs() *= -1.0;
    history.add(at_ms(ms), pose);
  }
  const auto span = (history.newest() - history.oldest()) / 1us;
  for (int k = 0; k < 500; ++k) {
    const Time t = history.oldest() + std::chrono::microseconds(random() % span);
    const auto pose = history.at(t);
    ASSERT_TRUE(pose.has_value());
    EXPECT_LT((pose->position - screw(t).position).norm(), 1e-12);
    EXPECT_LT(angle_between(pose->attitude, screw(t).attitude), 1e-7);
    EXPECT_NEAR(pose->attitude.norm(), 1.0, 1e-12);
  }
}

TEST(PoseHistory, TurnsOverTheShorterSide) {
  PoseHistory history(1s);
  history.add(at_ms(0), {Vector3d::Zero(), from_yaw(3.0)});
  history.add(at_ms(100), {Vector3d::Zero(), from_yaw(-3.0)});
  EXPECT_NEAR(std::abs(yaw_of(history.at(at_ms(50))->attitude)), M_PI, 1e-9);
}

TEST(PoseHistory, KnowsNothingOutsideItsTimes) {
  PoseHistory history(1s);
  EXPECT_TRUE(history.empty());
  EXPECT_FALSE(history.at(at_ms(0)).has_value());
  history.add(at_ms(100), {Vector3d(1, 0, 0), {}});
  EXPECT_FALSE(history.empty());
  ASSERT_TRUE(history.at(at_ms(100)).has_value()) << "the moment of a pose itself";
  EXPECT_EQ(history.at(at_ms(100))->position, Vector3d(1, 0, 0));
  EXPECT_FALSE(history.at(at_ms(100) - 1ns).has_value());
  EXPECT_FALSE(history.at(at_ms(100) + 1ns).has_value());
  history.add(at_ms(200), {Vector3d(2, 0, 0), {}});
  EXPECT_EQ(history.at(at_ms(200))->position, Vector3d(2, 0, 0));
  EXPECT_FALSE(history.at(at_ms(200) + 1ns).has_value());
}

TEST(PoseHistory, AGapIsNotBridged) {
  PoseHistory history(10s);
  for (const int ms : {0, 100, 600, 700}) history.add(at_ms(ms), {});
  EXPECT_TRUE(history.at(at_ms(50), 100ms).has_value()) << "as long as allowed";
  EXPECT_FALSE(history.at(at_ms(50), 99ms).has_value());
  EXPECT_FALSE(history.at(at_ms(300), 100ms).has_value());
  EXPECT_TRUE(history.at(at_ms(300)).has_value()) << "without a limit";
  EXPECT_TRUE(history.at(at_ms(600), 100ms).has_value()) << "its end is a pose";
  EXPECT_TRUE(history.at(at_ms(650), 100ms).has_value());
}

TEST(PoseHistory, ForgetsWhatIsOlderThanItsLength) {
  PoseHistory history(1s);
  for (int ms = 0; ms <= 5000; ms += 10) {
    history.add(at_ms(ms), {Vector3d(ms, 0, 0), {}});
    ASSERT_LE(history.newest() - history.oldest(), 1s);
  }
  EXPECT_EQ(history.oldest(), at_ms(4000));
  EXPECT_EQ(history.newest(), at_ms(5000));
  EXPECT_FALSE(history.at(at_ms(3990)).has_value());
  EXPECT_NEAR(history.at(at_ms(4005))->position.x(), 4005.0, 1e-9);
  // After a long silence only the new one is left.
  history.add(at_ms(60000), {});
  EXPECT_EQ(history.oldest(), history.newest());
}

TEST(PoseHistory, PosesOutOfOrderAreIgnored) {
  PoseHistory history(10s);
  history.add(at_ms(100), {Vector3d(1, 0, 0), {}});
  history.add(at_ms(200), {Vector3d(2, 0, 0), {}});
  history.add(at_ms(200), {Vector3d(9, 9, 9), {}});
  history.add(at_ms(150), {Vector3d(9, 9, 9), {}});
  history.add(at_ms(50), {Vector3d(9, 9, 9), {}});
  EXPECT_EQ(history.oldest(), at_ms(100));
  EXPECT_EQ(history.newest(), at_ms(200));
  EXPECT_NEAR(history.at(at_ms(150))->position.x(), 1.5, 1e-12);
  EXPECT_EQ(history.at(at_ms(200))->position, Vector3d(2, 0, 0));
  history.add(at_ms(300), {Vector3d(3, 0, 0), {}});
  EXPECT_NEAR(history.at(at_ms(250))->position.x(), 2.5, 1e-12);
}

}  // namespace
}  // namespace swiftlet
