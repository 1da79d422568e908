// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/pose_graph.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swiftlet::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPoses = 40;

/// Twice around a circle.
std::vector<Pose2> circle() {
  std::vector<Pose2> poses;
  for (int i = 0; i < kPoses; ++i) {
    const double angle = 4.0 * M_PI * i / kPoses;
    poses.push_back({{5.0 * std::cos(angle), 5.0 * std::sin(angle)}, wrap_angle(angle + M_PI_2)});
  }
  // The first one is the origin, since it stays.
  const Pose2 to_first = poses.front().inverse();
  for (Pose2& pose : poses) pose = to_first * pose;
  return poses;
}

const Matrix3d kInformation = Vector3d(1e4, 1e4, 4e4).asDiagonal();  // 1 cm, 0.3 degrees

PoseConstraint constraint(const std::vector<Pose2>& poses, int from, int to) {
  return {from, to,
          poses[static_cast<std::size_t>(from)].inverse() * poses[static_cast<std::size_t>(to)],
          kInformation, false};
}

/// What somebody who joins the steps one after the other believes.
std::vector<Pose2> chained(const std::vector<PoseConstraint>& steps) {
  std::vector<Pose2> poses{Pose2{}};
  for (const PoseConstraint& step : steps) poses.push_back(poses.back() * step.relative);
  return poses;
}

double largest_error(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth) {
  double largest = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    largest = std::max(largest, (poses[i].position - truth[i].position).norm());
  }
  return largest;
}

TEST(PoseGraph, ConstraintsThatAgreeGiveTheirPosesBack) {
  const std::vector<Pose2> truth = circle();
  std::vector<PoseConstraint> constraints;
  for (int i = 1; i < kPoses; ++i) constraints.push_back(constraint(truth, i - 1, i));
  for (int i = kPoses / 2; i < kPoses; ++i) {
    constraints.push_back(constraint(truth, i - kPoses / 2, i));
  }
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.2);
  std::vector<Pose2> poses = truth;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    poses[i].position += Vector2d(normal(random), normal(random));
    poses[i].yaw = wrap_angle(poses[i].yaw + normal(random));
  }
  const PoseGraphResult result = optimize_poses(poses, constraints, 50);
  EXPECT_LT(largest_error(poses, truth), 1e-3);
  EXPECT_LT(result.final_cost, 1e-3);
  EXPECT_GT(result.initial_cost, 1.0);
  EXPECT_EQ(poses.front().position, Vector2d::Zero());
}

class Drifting : public testing::Test {
 protected:
  Drifting() {
    for (int i = 1; i < kPoses; ++i) {
      PoseConstraint step = constraint(truth_, i - 1, i);
      step.relative.yaw += 0.008;  // ever to the left
      constraints_.push_back(step);
    }
    poses_ = chained(constraints_);
  }
  const std::vector<Pose2> truth_ = circle();
  std::vector<PoseConstraint> constraints_;
  std::vector<Pose2> poses_;
};

TEST_F(Drifting, AClosureTakesTheDriftAway) {
  ASSERT_GT(largest_error(poses_, truth_), 1.0);
  for (int i = kPoses / 2; i < kPoses; i += 3) {
    PoseConstraint closure = constraint(truth_, i - kPoses / 2, i);
    closure.robust = true;
    constraints_.push_back(closure);
  }
  optimize_poses(poses_, constraints_, 50);
  EXPECT_LT(largest_error(poses_, truth_), 0.3);
  // Where a closure holds, both rounds agree.
  EXPECT_LT((poses_[20].position - poses_[0].position).norm(), 0.05);
}

TEST_F(Drifting, AFalseClosureIsOutvoted) {
  for (int i = kPoses / 2; i < kPoses; i += 3) {
    PoseConstraint closure = constraint(truth_, i - kPoses / 2, i);
    closure.robust = true;
    constraints_.push_back(closure);
  }
  std::vector<Pose2> without = poses_;
  optimize_poses(without, constraints_, 50);
  PoseConstraint wrong = constraint(truth_, 5, 35);
  wrong.relative.position += Vector2d(3.0, -2.0);
  wrong.robust = true;
  constraints_.push_back(wrong);
  optimize_poses(poses_, constraints_, 50);
  EXPECT_LT(largest_error(poses_, without), 0.1);
}

TEST(PoseGraph, WithoutConstraintsNothingMoves) {
  std::vector<Pose2> poses{{{1, 2}, 0.3}, {{4, 5}, 0.6}};
  optimize_poses(poses, {});
  EXPECT_EQ(poses[1].position, Vector2d(4, 5));
  std::vector<Pose2> none;
  optimize_poses(none, {});
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace swiftlet::test
