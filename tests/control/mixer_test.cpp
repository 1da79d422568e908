// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mixer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

const QuadrotorModel kModel;
constexpr double kTolerance = 1e-9;

Vector4d forward(const Vector4d& rotor_thrusts) {
  return allocation_matrix(kModel) * rotor_thrusts;
}

Wrench random_wrench(std::mt19937_64& random, double scale) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double range = kModel.rotor_thrust_max - kModel.rotor_thrust_min;
  const double t = uniform(random), x = uniform(random), y = uniform(random), z = uniform(random);
  return {2.0 * kModel.rotor_thrust_max * (1.0 + scale * t),
          scale * range *
              Vector3d(kModel.arm_length * x, kModel.arm_length * y,
                       2.0 * kModel.torque_per_thrust * z)};
}

TEST(Mixer, GivesBackTheThrustsOfAnyFeasibleWrench) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> thrust(kModel.rotor_thrust_min, kModel.rotor_thrust_max);
  const Mixer mixer(kModel);
  for (int i = 0; i < 10000; ++i) {
    const Vector4d thrusts(thrust(random), thrust(random), thrust(random), thrust(random));
    const Vector4d w = forward(thrusts);
    const MixerOutput output = mixer.mix({w(0), w.tail<3>()});
    ASSERT_LT((output.rotor_thrusts - thrusts).norm(), kTolerance);
    ASSERT_FALSE(output.roll_pitch_limited || output.thrust_limited || output.yaw_limited);
  }
}

TEST(Mixer, AnyWrenchStaysWithinTheLimitsAndReportsWhatItGaveUp) {
  std::mt19937_64 random(2);
  const Mixer mixer(kModel);
  const double most = kModel.arm_length * (kModel.rotor_thrust_max - kModel.rotor_thrust_min);
  int yaw_only = 0, thrust_too = 0, all = 0;
  for (int i = 0; i < 50000; ++i) {
    const Wrench asked = random_wrench(random, 2.0);
    const MixerOutput output = mixer.mix(asked);
    ASSERT_GE(output.rotor_thrusts.minCoeff(), kModel.rotor_thrust_min);
    ASSERT_LE(output.rotor_thrusts.maxCoeff(), kModel.rotor_thrust_max);
    const Vector4d w = forward(output.rotor_thrusts);
    ASSERT_NEAR(output.achieved.thrust, w(0), kTolerance);
    ASSERT_LT((output.achieved.moment - w.tail<3>()).norm(), kTolerance);

    // Roll and pitch as asked wherever any thrust allows it, else as much as there is.
    ASSERT_NEAR(w(1), std::clamp(asked.moment.x(), -most, most), kTolerance);
    ASSERT_NEAR(w(2), std::clamp(asked.moment.y(), -most, most), kTolerance);
    const bool roll_pitch = std::abs(asked.moment.x()) > most || std::abs(asked.moment.y()) > most;
    ASSERT_EQ(output.roll_pitch_limited, roll_pitch);

    // Yaw smaller, never the wrong way; thrust only where yaw was given up altogether, or where it
    // cannot be had even without yaw.
    ASSERT_LE(std::abs(w(3)), std::abs(asked.moment.z()) + kTolerance);
    ASSERT_GE(w(3) * asked.moment.z(), -kTolerance);
    ASSERT_EQ(output.yaw_limited, std::abs(w(3) - asked.moment.z()) > 1e-8);
    ASSERT_EQ(output.thrust_limited, std::abs(w(0) - asked.thrust) > 1e-8);
    yaw_only += output.yaw_limited && !output.thrust_limited && !roll_pitch;
    thrust_too += output.thrust_limited && !roll_pitch;
    all += roll_pitch;
  }
  // Every branch was met.
  EXPECT_GT(yaw_only, 100);
  EXPECT_GT(thrust_too, 100);
  EXPECT_GT(all, 100);
}

TEST(Mixer, NoOtherChoiceWithinTheLimitsIsBetter) {
  std::mt19937_64 random(3);
  const Mixer mixer(kModel);
  const double most = kModel.arm_length * (kModel.rotor_thrust_max - kModel.rotor_thrust_min);
  constexpr int kGrid = 160;
  for (int i = 0; i < 600; ++i) {
    Wrench asked = random_wrench(random, 1.2);
    asked.moment.x() = std::clamp(asked.moment.x(), -most, most);
    asked.moment.y() = std::clamp(asked.moment.y(), -most, most);
    const MixerOutput output = mixer.mix(asked);
    const double thrust_error = std::abs(output.achieved.thrust - asked.thrust);
    const double yaw_error = std::abs(output.achieved.moment.z() - asked.moment.z());
    // All pairs (f1, f2); roll and pitch give f3 and f4.
    const double step = (kModel.rotor_thrust_max - kModel.rotor_thrust_min) / kGrid;
    for (int a = 0; a <= kGrid; ++a) {
      for (int b = 0; b <= kGrid; ++b) {
        const double f1 = kModel.rotor_thrust_min + a * step;
        const double f2 = kModel.rotor_thrust_min + b * step;
        const Vector4d f(f1, f2, f1 + asked.moment.y() / kModel.arm_length,
                         f2 + asked.moment.x() / kModel.arm_length);
        if (f.minCoeff() < kModel.rotor_thrust_min || f.maxCoeff() > kModel.rotor_thrust_max)
          continue;
        const Vector4d w = forward(f);
        if (w(3) * asked.moment.z() < 0.0 || std::abs(w(3)) > std::abs(asked.moment.z())) continue;
        const double other_thrust_error = std::abs(w(0) - asked.thrust);
        ASSERT_GE(other_thrust_error, thrust_error - kTolerance);
        // As good in thrust: then not better in yaw.
        if (other_thrust_error <= thrust_error + kTolerance) {
          ASSERT_GE(std::abs(w(3) - asked.moment.z()), yaw_error - kTolerance);
        }
      }
    }
  }
}

TEST(Mixer, MoreYawThanThereIsTakesNothingFromTheRest) {
  const Mixer mixer(kModel);
  const MixerOutput output = mixer.mix({9.0, {0.2, -0.3, 10.0}});
  EXPECT_NEAR(output.achieved.thrust, 9.0, kTolerance);
  EXPECT_NEAR(output.achieved.moment.x(), 0.2, kTolerance);
  EXPECT_NEAR(output.achieved.moment.y(), -0.3, kTolerance);
  EXPECT_GT(output.achieved.moment.z(), 0.0);
  EXPECT_TRUE(output.yaw_limited);
  EXPECT_FALSE(output.thrust_limited || output.roll_pitch_limited);
}

TEST(Mixer, StrongPitchAtLowThrustRaisesThrustRatherThanYawTheWrongWay) {
  const Mixer mixer(kModel);
  const double pitch =
      0.8 * kModel.arm_length * (kModel.rotor_thrust_max - kModel.rotor_thrust_min);
  const MixerOutput output = mixer.mix({1.0, {0.0, pitch, -0.01}});
  EXPECT_NEAR(output.achieved.moment.y(), pitch, kTolerance);
  EXPECT_NEAR(output.achieved.moment.z(), 0.0, kTolerance);
  EXPECT_GT(output.achieved.thrust, 1.0);
  EXPECT_TRUE(output.thrust_limited);
}

TEST(Mixer, AWrenchThatIsNotFiniteBecomesHover) {
  const Mixer mixer(kModel);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 4; ++i) {
      Wrench wrench{9.0, Vector3d::Zero()};
      (i == 0 ? wrench.thrust : wrench.moment(i - 1)) = bad;
      const MixerOutput output = mixer.mix(wrench);
      EXPECT_TRUE(output.input_refused);
      EXPECT_NEAR(output.achieved.thrust, kModel.mass * 9.80665, kTolerance);
      EXPECT_LT(output.achieved.moment.norm(), kTolerance);
    }
  }
  const MixerOutput huge = mixer.mix({1e308, {-1e308, 1e308, -1e308}});
  EXPECT_TRUE(huge.rotor_thrusts.allFinite());
}

TEST(Mixer, UnusableModelsThrow) {
  QuadrotorModel model;
  model.rotor_thrust_max = model.rotor_thrust_min;
  EXPECT_THROW(Mixer{model}, std::invalid_argument);
  model = {};
  model.arm_length = 0.0;
  EXPECT_THROW(Mixer{model}, std::invalid_argument);
  EXPECT_EQ(Mixer::motors_off().norm(), 0.0);
}

}  // namespace
}  // namespace swiftlet
