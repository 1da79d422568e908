// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <limits>
#include <vector>

#include "tests/estimation/ukf/imu_simulation.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using Outcome = PoseImuUkf::Outcome;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDt = 0.005;
const Matrix6d kCovariance = pose_covariance(0.02, 0.01);
const ImuSample kHover{Vector3d::Zero(), {0, 0, kGravity}};

PoseMeasurement pose_at(const Vector3d& p_WB) {
  return {p_WB, Quaterniond::Identity(), kCovariance};
}

/// A filter that has hovered at the origin for a second.
PoseImuUkf hovering() {
  PoseImuUkf filter;
  EXPECT_TRUE(filter.initialize(at(0), pose_at(Vector3d::Zero())));
  for (int k = 0; k <= 200; ++k) {
    EXPECT_TRUE(filter.predict(at(k * kDt), kHover));
    if (k % 7 == 0) {
      EXPECT_EQ(filter.update(at(k * kDt), pose_at(Vector3d::Zero())).outcome, Outcome::kUsed);
    }
  }
  return filter;
}

void expect_same(const PoseImuUkf& a, const PoseImuUkf& b) {
  EXPECT_EQ(a.time(), b.time());
  EXPECT_EQ(a.state().p_WB, b.state().p_WB);
  EXPECT_EQ(a.state().v_WB_W, b.state().v_WB_W);
  EXPECT_EQ(a.state().q_WB.coeffs(), b.state().q_WB.coeffs());
  EXPECT_EQ(a.state().w_WB_B, b.state().w_WB_B);
  EXPECT_EQ(a.accelerometer_bias(), b.accelerometer_bias());
  EXPECT_EQ(a.covariance(), b.covariance());
}

void expect_healthy(const PoseImuUkf& filter) {
  ASSERT_TRUE(filter.state().p_WB.allFinite() && filter.state().v_WB_W.allFinite());
  ASSERT_TRUE(filter.covariance().allFinite() && filter.accelerometer_bias().allFinite());
  ASSERT_NEAR(filter.state().q_WB.norm(), 1.0, 1e-12);
  ASSERT_EQ(filter.covariance(), filter.covariance().transpose());
  const Eigen::SelfAdjointEigenSolver<PoseImuUkf::Covariance> eigen(filter.covariance());
  ASSERT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
}

TEST(PoseImuUkfRefusal, BadMeasurementsAreNamedAndChangeNothing) {
  struct Case {
    const char* reason;
    std::function<void(PoseMeasurement&)> spoil;
  };
  const std::vector<Case> cases{
      {"position is not finite", [](auto& z) { z.p_WB.y() = kNan; }},
      {"position is not finite", [](auto& z) { z.p_WB.x() = kInf; }},
      {"position beyond", [](auto& z) { z.p_WB.z() = 1e7; }},
      {"quaternion is not finite", [](auto& z) { z.q_WB.w() = kNan; }},
      {"quaternion of length 0", [](auto& z) { z.q_WB.coeffs().setZero(); }},
      {"quaternion of length 2", [](auto& z) { z.q_WB.coeffs() *= 2.0; }},
      {"quaternion of length", [](auto& z) { z.q_WB.coeffs() *= 1e300; }},
      {"covariance is not finite", [](auto& z) { z.covariance(2, 3) = kNan; }},
      {"variances", [](auto& z) { z.covariance.setZero(); }},
      {"variances", [](auto& z) { z.covariance(1, 1) = -1.0; }},
      {"variances", [](auto& z) { z.covariance *= 1e300; }},
      {"not symmetric", [](auto& z) { z.covariance(0, 1) = 1e-5; }},
      {"not positive definite", [](auto& z) { z.covariance(0, 1) = z.covariance(1, 0) = 1e-3; }},
  };
  for (const Case& c : cases) {
    PoseImuUkf filter = hovering();
    const PoseImuUkf before = filter;
    PoseMeasurement z = pose_at(Vector3d::Zero());
    c.spoil(z);
    const UpdateReport report = filter.update(at(1.0), z);
    EXPECT_EQ(report.outcome, Outcome::kRefused) << c.reason;
    EXPECT_THAT(report.reason, HasSubstr(c.reason));
    expect_same(filter, before);
    PoseImuUkf fresh;
    const Status status = fresh.initialize(at(0), z);
    ASSERT_FALSE(status) << c.reason;
    EXPECT_THAT(status.error().reason, HasSubstr(c.reason));
    EXPECT_FALSE(fresh.initialized());
  }
}

TEST(PoseImuUkfRefusal, BadImuSamplesAreNamedAndChangeNothing) {
  struct Case {
    const char* reason;
    ImuSample imu;
  };
  const std::vector<Case> cases{
      {"not finite", {{kNan, 0, 0}, {0, 0, 9.8}}},
      {"not finite", {{0, 0, 0}, {0, -kInf, 9.8}}},
      {"not believable", {{0, 100, 0}, {0, 0, 9.8}}},
      {"not believable", {{0, 0, 0}, {1e300, 1e300, 9.8}}},
  };
  for (const Case& c : cases) {
    PoseImuUkf filter = hovering();
    const PoseImuUkf before = filter;
    const Status status = filter.predict(at(1.005), c.imu);
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().reason, HasSubstr(c.reason));
    expect_same(filter, before);
  }
}

TEST(PoseImuUkfRefusal, TimeNeitherRunsBackwardsNorJumps) {
  PoseImuUkf filter = hovering();
  const PoseImuUkf before = filter;
  EXPECT_THAT(filter.predict(at(0.99), kHover).error().reason, HasSubstr("backwards by 0.01 s"));
  EXPECT_THAT(filter.predict(at(1.2), kHover).error().reason, HasSubstr("jumps by 0.2 s"));
  EXPECT_FALSE(filter.predict(Time::min(), kHover));
  EXPECT_FALSE(filter.predict(Time::max(), kHover));
  const PoseMeasurement z = pose_at(Vector3d::Zero());
  EXPECT_THAT(filter.update(at(0.9), z).reason, HasSubstr("0.1 s older"));
  EXPECT_THAT(filter.update(at(1.5), z).reason, HasSubstr("0.5 s ahead"));
  EXPECT_EQ(filter.update(Time::min(), z).outcome, Outcome::kRefused);
  EXPECT_EQ(filter.update(Time::max(), z).outcome, Outcome::kRefused);
  expect_same(filter, before);
}

TEST(PoseImuUkfRefusal, NothingHappensBeforeTheFirstPose) {
  PoseImuUkf filter;
  EXPECT_THAT(filter.predict(at(0), kHover).error().reason, HasSubstr("before the first pose"));
  EXPECT_EQ(filter.update(at(0), pose_at(Vector3d::Zero())).outcome, Outcome::kRefused);
  EXPECT_FALSE(filter.initialized());
}

TEST(PoseImuUkfRefusal, UnusableParametersThrow) {
  PoseImuUkf::Params params;
  params.gyro_noise = kNan;
  EXPECT_THROW(PoseImuUkf{params}, std::invalid_argument);
  params = {};
  params.gate = 0.0;
  EXPECT_THROW(PoseImuUkf{params}, std::invalid_argument);
}

TEST(PoseImuUkfGate, AnOutlierIsRejectedAndTheNextGoodPoseUsed) {
  PoseImuUkf filter = hovering();
  const RigidBodyState before = filter.state();
  const UpdateReport outlier = filter.update(at(1.0), pose_at({0.5, 0, 0}));
  EXPECT_EQ(outlier.outcome, Outcome::kRejected);
  EXPECT_GT(outlier.nis, PoseImuUkf::Params{}.gate);
  EXPECT_THAT(outlier.reason, HasSubstr("innovation of 0.5 m"));
  EXPECT_EQ(filter.state().p_WB, before.p_WB);
  EXPECT_EQ(filter.update(at(1.0), pose_at({0.01, 0, 0})).outcome, Outcome::kUsed);
}

TEST(PoseImuUkfGate, AWorldThatMovedIsFollowedAfterAWhileAndReported) {
  PoseImuUkf filter = hovering();
  const Vector3d bias = filter.accelerometer_bias();
  const Vector3d there(3, -2, 1);
  double restarted_at = 0.0;
  // One stamp from the far future must not hold up what follows.
  EXPECT_EQ(filter.update(Time::max(), pose_at(there)).outcome, Outcome::kRefused);
  for (int k = 201; k <= 600; ++k) {
    const double t = k * kDt;
    ASSERT_TRUE(filter.predict(at(t), kHover));
    if (k % 7 != 0) continue;
    const UpdateReport report = filter.update(at(t), pose_at(there));
    if (report.outcome == Outcome::kReinitialized) {
      EXPECT_EQ(restarted_at, 0.0) << "restarted twice";
      EXPECT_THAT(report.reason, HasSubstr("rejections"));
      EXPECT_EQ(filter.state().p_WB, there);
      EXPECT_LT((filter.accelerometer_bias() - bias).norm(), 1e-9);
      restarted_at = t;
    } else {
      EXPECT_EQ(report.outcome, restarted_at > 0.0 ? Outcome::kUsed : Outcome::kRejected);
    }
  }
  EXPECT_NEAR(restarted_at, 1.0 + PoseImuUkf::Params{}.reset_after, 0.08);
  EXPECT_LT((filter.state().p_WB - there).norm(), 0.02);
}

TEST(PoseImuUkfGate, GarbageThatDoesNotAgreeWithItselfNeverRestartsTheFilter) {
  PoseImuUkf filter = hovering();
  Noise noise(13);
  for (int k = 201; k <= 1200; ++k) {
    const double t = k * kDt;
    ASSERT_TRUE(filter.predict(at(t), kHover));
    if (k % 7 != 0) continue;
    const Vector3d garbage = 200.0 * noise.vector();
    EXPECT_EQ(filter.update(at(t), pose_at(garbage)).outcome, Outcome::kRejected) << garbage;
  }
  EXPECT_LT(filter.state().p_WB.norm(), 1.0);
}

TEST(PoseImuUkfGate, AfterAGapOfTheImuThePoseRestartsTheFilter) {
  PoseImuUkf filter = hovering();
  bool restarted = false;
  for (int k = 0; k < 60 && !restarted; ++k) {
    const double t = 1.5 + 0.033 * k;
    EXPECT_FALSE(filter.predict(at(t), kHover));
    restarted = filter.update(at(t), pose_at({0.2, 0, 0})).outcome == Outcome::kReinitialized;
    if (restarted) {
      EXPECT_TRUE(filter.predict(at(t + kDt), kHover));
    }
  }
  EXPECT_TRUE(restarted);
}

TEST(PoseImuUkfHealth, HostileInputsNeverBreakQuaternionOrCovariance) {
  for (unsigned long seed = 0; seed < 20; ++seed) {
    Noise noise(100 + seed);
    std::uniform_int_distribution<int> pick(0, 19);
    PoseImuUkf filter;
    const auto wild = [&] { return noise() * std::pow(10.0, 3.0 * noise()); };
    const auto any = [&] {
      switch (pick(noise.random)) {
        case 0:
          return kNan;
        case 1:
          return kInf;
        case 2:
          return wild();
        default:
          return noise();
      }
    };
    double t = 0.0;
    for (int k = 0; k < 3000; ++k) {
      t += pick(noise.random) == 0 ? 0.3 * noise() : 0.01 * std::abs(noise());
      ImuSample imu{{any(), any(), any()}, {10 * any(), 10 * any(), 10 * any()}};
      if (pick(noise.random) < 10) imu = kHover;
      (void)filter.predict(at(t), imu);
      PoseMeasurement z{{any(), any(), any()}, exp_so3(noise.vector()), kCovariance};
      if (pick(noise.random) < 3) z.q_WB.x() = any();
      Matrix6d L;
      for (int i = 0; i < 36; ++i) L(i) = std::pow(10.0, noise()) * noise();
      if (pick(noise.random) < 10) z.covariance = L * L.transpose() * std::pow(10.0, 3 * noise());
      if (!filter.initialized()) {
        (void)filter.initialize(at(t), z);
      } else if (k % 3 == 0) {
        filter.update(at(t), z);
      }
      expect_healthy(filter);
      if (HasFatalFailure()) FAIL() << "seed " << seed << " step " << k;
    }
    EXPECT_TRUE(filter.initialized());
  }
}

TEST(PoseImuUkfHealth, ACovarianceThatRoundingMadeIndefiniteIsRepairedAndCounted) {
  std::uint64_t repairs = 0;
  for (unsigned long seed = 0; seed < 200; ++seed) {
    Noise noise(seed);
    // All directions but one are known to the last digit of the remaining one.
    Vector6d direction;
    for (int i = 0; i < 6; ++i) direction(i) = noise();
    PoseMeasurement z = pose_at(Vector3d::Zero());
    z.covariance = direction * direction.transpose() + 3e-16 * Matrix6d::Identity();
    z.covariance = 0.5 * (z.covariance + z.covariance.transpose()).eval();
    PoseImuUkf filter;
    if (!filter.initialize(at(0), z)) continue;
    for (int k = 0; k < 20; ++k) {
      ASSERT_TRUE(filter.predict(at(k * 1e-6), kHover));
      expect_healthy(filter);
    }
    repairs += filter.covariance_repairs();
  }
  EXPECT_GT(repairs, 0u);
}

}  // namespace
}  // namespace swiftlet::test
