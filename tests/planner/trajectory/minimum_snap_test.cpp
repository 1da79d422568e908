// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/minimum_snap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

constexpr double kPi = 3.14159265358979323846;

FlatReference at_rest(const Eigen::Vector3d& position, double yaw = 0.0) {
  FlatReference start;
  start.position = position;
  start.yaw = yaw;
  return start;
}

FlatReference moving(std::mt19937& random, double speed, double acceleration) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(u(random), u(random), u(random)); };
  FlatReference start;
  start.position = vector();
  start.velocity = speed * vector() / 1.8;
  start.acceleration = acceleration * vector() / 1.8;
  start.jerk = vector();
  start.yaw = 3 * u(random);
  start.yaw_rate = 0.5 * u(random);
  return start;
}

std::vector<Waypoint> random_waypoints(std::mt19937& random, int n, double size) {
  std::uniform_real_distribution<double> u(-size, size), yaw(-kPi, kPi);
  std::vector<Waypoint> waypoints(static_cast<std::size_t>(n));
  for (Waypoint& w : waypoints) {
    w.position = {u(random), u(random), 0.3 * u(random)};
    w.yaw = yaw(random);
  }
  return waypoints;
}

/// The minimum by brute force, for one axis: all coefficients of all pieces in seconds, one dense
/// system of Karush, Kuhn and Tucker for the integral of the squared snap, with the constraints
/// written out one by one.
Eigen::VectorXd dense_minimum(const std::vector<double>& T, const Eigen::Vector4d& start,
                              const std::vector<double>& ends) {
  const int n = static_cast<int>(T.size()), N = 8 * n;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(N, N);
  for (int p = 0; p < n; ++p) {
    const double t = T[static_cast<std::size_t>(p)];
    for (int i = 4; i < 8; ++i) {
      for (int j = 4; j < 8; ++j) {
        const double a = i * (i - 1) * (i - 2) * (i - 3), b = j * (j - 1) * (j - 2) * (j - 3);
        H(8 * p + i, 8 * p + j) = 2 * a * b * std::pow(t, i + j - 7) / (i + j - 7);
      }
    }
  }
  std::vector<Eigen::RowVectorXd> rows;
  std::vector<double> right;
  const auto row = [&](int piece, double t, int order) {
    Eigen::RowVectorXd r = Eigen::RowVectorXd::Zero(N);
    for (int i = order; i < 8; ++i) {
      double factor = 1.0;
      for (int k = 0; k < order; ++k) factor *= i - k;
      r[8 * piece + i] = factor * std::pow(t, i - order);
    }
    return r;
  };
  for (int k = 0; k < 4; ++k) {
    rows.push_back(row(0, 0.0, k));
    right.push_back(start[k]);
  }
  for (int p = 0; p < n; ++p) {
    const double t = T[static_cast<std::size_t>(p)];
    rows.push_back(row(p, t, 0));
    right.push_back(ends[static_cast<std::size_t>(p)]);
    for (int k = 1; k < 4; ++k) {
      rows.push_back(p + 1 < n ? Eigen::RowVectorXd(row(p, t, k) - row(p + 1, 0.0, k))
                               : row(p, t, k));
      right.push_back(0.0);
    }
    if (p + 1 < n) {
      rows.push_back(row(p + 1, 0.0, 0));
      right.push_back(ends[static_cast<std::size_t>(p)]);
    }
  }
  const int M = static_cast<int>(rows.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(N + M, N + M);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(N + M);
  K.topLeftCorner(N, N) = H;
  for (int m = 0; m < M; ++m) {
    K.block(N + m, 0, 1, N) = rows[static_cast<std::size_t>(m)];
    K.block(0, N + m, N, 1) = rows[static_cast<std::size_t>(m)].transpose();
    b[N + m] = right[static_cast<std::size_t>(m)];
  }
  return K.fullPivLu().solve(b).head(N);
}

TEST(MinimumSnap, IsTheMinimumThatADenseSolutionFinds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> duration(0.8, 2.5);
  for (int n = 1; n <= 5; ++n) {
    for (int trial = 0; trial < 10; ++trial) {
      const FlatReference start = moving(random, 1.0, 1.0);
      const std::vector<Waypoint> waypoints = random_waypoints(random, n, 3.0);
      std::vector<double> T(static_cast<std::size_t>(n));
      for (double& t : T) t = duration(random);
      const auto trajectory = minimum_snap(Time{}, start, waypoints, T);
      ASSERT_TRUE(trajectory.ok());
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> ends;
        for (const Waypoint& w : waypoints) ends.push_back(w.position[axis]);
        const Eigen::Vector4d begin(start.position[axis], start.velocity[axis],
                                    start.acceleration[axis], start.jerk[axis]);
        const Eigen::VectorXd expected = dense_minimum(T, begin, ends);
        for (int p = 0; p < n; ++p) {
          const auto& segment = trajectory->segments()[static_cast<std::size_t>(p)];
          for (const double s : {0.1, 0.35, 0.5, 0.8}) {
            double value = 0.0;
            for (int i = 7; i >= 0; --i)
              value = value * s * segment.duration_s + expected[8 * p + i];
            EXPECT_NEAR(derivative(segment, axis, s, 0), value, 1e-6) << n << " piece " << p;
          }
        }
      }
    }
  }
}

TEST(MinimumSnap, ARestToRestLineIsTheKnownPolynomial) {
  // 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7: greatest speed 35/16 of the mean one.
  const auto trajectory = minimum_snap(Time{}, at_rest({0, 0, 1}), {{{2, 0, 1}, 0.0}}, {4.0});
  ASSERT_TRUE(trajectory.ok());
  const Polynomial& c = trajectory->segments()[0].coefficients[kX];
  EXPECT_NEAR(c[4], 70, 1e-9);
  EXPECT_NEAR(c[5], -168, 1e-9);
  EXPECT_NEAR(c[6], 140, 1e-9);
  EXPECT_NEAR(c[7], -40, 1e-9);
  EXPECT_NEAR(trajectory->max_speed(), 35.0 / 16 * 2.0 / 4.0, 1e-6);
}

TEST(MinimumSnap, TheOvalOfSeed000) {
  // Its four points in 9 s, from rest at P1 and back to it.
  const Eigen::Vector3d p1(-1, -1.5, -1.2), p2(0, -0.5, -1.2), p3(0, 0.5, -1.2);
  const auto trajectory =
      minimum_snap(Time{}, at_rest(p1), {{p2, 0.0}, {p3, 0.0}, {p1, 0.0}}, {3.0, 2.0, 4.0});
  ASSERT_TRUE(trajectory.ok());
  EXPECT_NEAR(to_seconds(trajectory->duration()), 9.0, 1e-9);
  EXPECT_LT((trajectory->evaluate(Time(from_seconds(3.0))).position - p2).norm(), 1e-9);
  EXPECT_LT((trajectory->evaluate(Time(from_seconds(5.0))).position - p3).norm(), 1e-9);
  // "The velocity reaches values of 1 m/s."
  EXPECT_NEAR(trajectory->max_speed(), 1.0, 0.35);
}

TEST(MinimumSnap, IsContinuousUpToTheSixthDerivative) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const auto waypoints = random_waypoints(random, 8, 4.0);
    const FlatReference start = moving(random, 1.0, 1.0);
    std::vector<double> T;
    for (int i = 0; i < 8; ++i) T.push_back(0.5 + 0.4 * static_cast<double>(random() % 8));
    const auto trajectory = minimum_snap(Time{}, start, waypoints, T);
    ASSERT_TRUE(trajectory.ok());
    const auto& segments = trajectory->segments();
    for (int axis = 0; axis < 4; ++axis) {
      for (int order = 0; order <= 6; ++order) {
        for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
          const double scale = 1.0 + std::abs(derivative(segments[i], axis, 1.0, order));
          ASSERT_NEAR(derivative(segments[i], axis, 1.0, order),
                      derivative(segments[i + 1], axis, 0.0, order), 1e-7 * scale)
              << "axis " << axis << " order " << order;
        }
      }
      for (int order = 1; order <= 3; ++order) {
        ASSERT_NEAR(derivative(segments.back(), axis, 1.0, order), 0.0, 1e-9);
      }
    }
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Eigen::Vector3d end(derivative(segments[i], kX, 1, 0),
                                derivative(segments[i], kY, 1, 0),
                                derivative(segments[i], kZ, 1, 0));
      ASSERT_LT((end - waypoints[i].position).norm(), 1e-9);
      ASSERT_NEAR(wrap_angle(derivative(segments[i], kYaw, 1, 0) - waypoints[i].yaw), 0.0, 1e-9);
    }
    const FlatReference first = trajectory->evaluate(Time{});
    ASSERT_LT((first.velocity - start.velocity).norm(), 1e-9);
    ASSERT_LT((first.acceleration - start.acceleration).norm(), 1e-9);
    ASSERT_LT((first.jerk - start.jerk).norm(), 1e-8);
    ASSERT_NEAR(first.yaw_rate, start.yaw_rate, 1e-9);
  }
}

TEST(MinimumSnap, StaysWellConditionedForManyAndForUnequalPieces) {
  std::mt19937 random(3);
  const auto waypoints = random_waypoints(random, 400, 5.0);
  std::vector<double> T;
  for (int i = 0; i < 400; ++i) T.push_back(i % 7 == 0 ? 0.15 : 3.0);
  const auto trajectory = minimum_snap(Time{}, at_rest({0, 0, 0}), waypoints, T);
  ASSERT_TRUE(trajectory.ok());
  for (std::size_t i = 0; i + 1 < 400; ++i) {
    const double before = derivative(trajectory->segments()[i], kX, 1.0, 4);
    const double after = derivative(trajectory->segments()[i + 1], kX, 0.0, 4);
    ASSERT_NEAR(before, after, 1e-5 * (1.0 + std::abs(before)));
  }
}

TEST(MinimumSnap, YawTurnsOverTheShorterSide) {
  const auto trajectory = minimum_snap(Time{}, at_rest({0, 0, 0}, 3.0), {{{1, 0, 0}, -3.0}}, {2.0});
  ASSERT_TRUE(trajectory.ok());
  EXPECT_NEAR(trajectory->final_reference().yaw, -3.0 + 2 * kPi, 1e-9);
}

/// Norms by dense sampling, of which the limits are to be kept.
std::pair<double, double> sampled_extrema(const Trajectory& trajectory) {
  double speed = 0.0, acceleration = 0.0;
  for (const TrajectorySegment& segment : trajectory.segments()) {
    for (int i = 0; i <= 60; ++i) {
      Eigen::Vector3d v, a;
      for (int axis = 0; axis < 3; ++axis) {
        v[axis] = derivative(segment, axis, i / 60.0, 1);
        a[axis] = derivative(segment, axis, i / 60.0, 2);
      }
      speed = std::max(speed, v.norm());
      acceleration = std::max(acceleration, a.norm());
    }
  }
  return {speed, acceleration};
}

TEST(MinimumSnapPlanner, ATrajectoryCanBeLeftForAnotherAtAnyMoment) {
  // What replanning does: from any moment of a trajectory on to other waypoints.
  std::mt19937 random(6);
  std::uniform_real_distribution<double> moment(0.05, 0.95);
  const MinimumSnapPlanner planner;
  int done = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const auto first = planner.plan(Time{}, at_rest({0, 0, 1}), random_waypoints(random, 3, 4.0));
    ASSERT_TRUE(first.ok());
    const Time change{from_seconds(moment(random) * to_seconds(first->duration()))};
    const FlatReference start = first->evaluate(change);
    const auto second = planner.plan(change, start, random_waypoints(random, 3, 4.0));
    if (!second.ok()) continue;
    ++done;
    EXPECT_LE(second->max_speed(), 1.0);
    EXPECT_LE(second->max_acceleration(), 1.0);
    EXPECT_LT((second->evaluate(change).jerk - start.jerk).norm(), 1e-6);
  }
  EXPECT_GE(done, 495);
}

TEST(MinimumSnapPlanner, TenThousandTrajectoriesKeepTheirLimits) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> limit(0.3, 4.0);
  int from_rest_failed = 0, moving_ok = 0, moving_failed = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    MinimumSnapPlanner::Params params;
    params.max_speed = limit(random);
    params.max_acceleration = limit(random);
    const bool rest = trial % 4 != 0;
    const FlatReference start =
        rest ? at_rest({0, 0, 1})
             : moving(random, 0.8 * params.max_speed, 0.5 * params.max_acceleration);
    const int n = 1 + static_cast<int>(random() % 6);
    const auto result =
        MinimumSnapPlanner(params).plan(Time{}, start, random_waypoints(random, n, 5.0));
    if (!result.ok()) {
      ++(rest ? from_rest_failed : moving_failed);
      continue;
    }
    moving_ok += !rest;
    const auto [speed, acceleration] = sampled_extrema(*result);
    ASSERT_LE(speed, params.max_speed * (1 + 1e-9)) << trial;
    ASSERT_LE(acceleration, params.max_acceleration * (1 + 1e-9)) << trial;
    const FlatReference first = result->evaluate(Time{});
    ASSERT_LT((first.velocity - start.velocity).norm(), 1e-6) << trial;
    ASSERT_LT((first.acceleration - start.acceleration).norm(), 1e-6) << trial;
  }
  EXPECT_EQ(from_rest_failed, 0);
  EXPECT_LT(moving_failed, moving_ok / 10);
}

TEST(MinimumSnapPlanner, UsesTheLimitsThatItHas) {
  // 20 m in a line at 1 m/s and 1 m/s^2 take 21 s at the least.
  std::vector<Waypoint> line;
  for (int i = 1; i <= 20; ++i) line.push_back({{1.0 * i, 0, 1}, 0.0});
  const auto result = MinimumSnapPlanner().plan(Time{}, at_rest({0, 0, 1}), line);
  ASSERT_TRUE(result.ok());
  EXPECT_GT(to_seconds(result->duration()), 21.0);
  EXPECT_LT(to_seconds(result->duration()), 21.0 * 1.35);
}

TEST(MinimumSnapPlanner, SaysWhyNot) {
  const MinimumSnapPlanner planner;
  FlatReference fast = at_rest({0, 0, 1});
  fast.velocity.x() = 1.5;
  const auto too_fast = planner.plan(Time{}, fast, {{{5, 0, 1}, 0.0}});
  ASSERT_FALSE(too_fast.ok());
  EXPECT_THAT(too_fast.error().reason, testing::HasSubstr("1.5 m/s"));
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, 1}), {}).ok());
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, std::nan("")}), {{{5, 0, 1}, 0.0}}).ok());
  EXPECT_FALSE(planner.plan(Time{}, at_rest({0, 0, 1}), {{{5, std::nan(""), 1}, 0.0}}).ok());
  EXPECT_FALSE(minimum_snap(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0.0}}, {-1.0}).ok());
  EXPECT_FALSE(minimum_snap(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0.0}}, {1.0, 1.0}).ok());
  MinimumSnapPlanner::Params params;
  params.max_speed = std::nan("");
  EXPECT_FALSE(MinimumSnapPlanner(params).plan(Time{}, at_rest({0, 0, 1}), {{{5, 0, 1}, 0}}).ok());
}

TEST(MinimumSnapPlanner, AWaypointWhereItStandsAlreadyIsNoTrouble) {
  const auto result = MinimumSnapPlanner().plan(Time{}, at_rest({1, 2, 1}), {{{1, 2, 1}, 0.0}});
  ASSERT_TRUE(result.ok());
  EXPECT_LT((result->final_reference().position - Eigen::Vector3d(1, 2, 1)).norm(), 1e-12);
}

}  // namespace
}  // namespace swiftlet
