// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/minimum_snap.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <random>

#include "estimation/geometry/so3.hpp"
#include "tests/planner/trajectory/random_waypoints.hpp"

namespace swiftlet {
namespace {

constexpr double kPi = 3.14159265358979323846;

using test::at_rest;
using test::moving;
using test::random_waypoints;

/// One axis of a waypoint.
struct End {
  double position;
  std::optional<double> velocity = {}, acceleration = {};
};

struct DenseMinimum {
  Eigen::VectorXd coefficients;  // 8 a piece, in the normalised time of the piece
  double cost;
};

/// The minimum by brute force, for one axis: all coefficients of all pieces, one dense system of
/// Karush, Kuhn and Tucker for the integral of the squared snap, with the constraints written out
/// one by one, in numbers of 64 bits of mantissa.
DenseMinimum dense_minimum(const std::vector<double>& T, const Eigen::Vector4d& start,
                           const std::vector<End>& ends) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Row = Eigen::Matrix<Real, 1, Eigen::Dynamic>;
  const int n = static_cast<int>(T.size()), N = 8 * n;
  const auto duration = [&](int piece) -> Real { return T[static_cast<std::size_t>(piece)]; };
  Matrix H = Matrix::Zero(N, N);
  for (int p = 0; p < n; ++p) {
    for (int i = 4; i < 8; ++i) {
      for (int j = 4; j < 8; ++j) {
        const Real a = i * (i - 1) * (i - 2) * (i - 3), b = j * (j - 1) * (j - 2) * (j - 3);
        H(8 * p + i, 8 * p + j) = 2 * a * b / (i + j - 7) / std::pow(duration(p), Real(7));
      }
    }
  }
  std::vector<Row> rows;
  std::vector<Real> right;
  // The derivative in time at the beginning or at the end of a piece.
  const auto row = [&](int piece, bool at_end, int order) {
    Row r = Row::Zero(N);
    for (int i = order; i < (at_end ? 8 : order + 1); ++i) {
      Real factor = 1;
      for (int k = 0; k < order; ++k) factor *= i - k;
      r[8 * piece + i] = factor / std::pow(duration(piece), Real(order));
    }
    return r;
  };
  const auto demand = [&](const Row& r, Real value) {
    const Real size = r.cwiseAbs().maxCoeff();
    rows.push_back(r / size);
    right.push_back(value / size);
  };
  for (int k = 0; k < 4; ++k) demand(row(0, false, k), start[k]);
  for (int p = 0; p < n; ++p) {
    const End& end = ends[static_cast<std::size_t>(p)];
    const bool last = p + 1 == n;
    const std::optional<double> given[] = {end.position, end.velocity, end.acceleration, {}};
    for (int k = 0; k < 4; ++k) {
      if (given[k] || last) demand(row(p, true, k), given[k].value_or(0.0));
      if (!last) demand(row(p, true, k) - row(p + 1, false, k), 0);
    }
  }
  const int M = static_cast<int>(rows.size());
  Matrix K = Matrix::Zero(N + M, N + M);
  Vector b = Vector::Zero(N + M);
  K.topLeftCorner(N, N) = H;
  for (int m = 0; m < M; ++m) {
    K.block(N + m, 0, 1, N) = rows[static_cast<std::size_t>(m)];
    K.block(0, N + m, N, 1) = rows[static_cast<std::size_t>(m)].transpose();
    b[N + m] = right[static_cast<std::size_t>(m)];
  }
  const Vector x = K.fullPivLu().solve(b).head(N);
  const Real cost = x.dot(H * x) / 2;
  return {x.cast<double>(), static_cast<double>(cost)};
}

/// `prescribed`: the share of waypoints that prescribe a velocity or an acceleration.
void expect_dense_minimum(std::mt19937& random, int n, double prescribed) {
  std::uniform_real_distribution<double> duration(0.8, 2.5), u(-1.0, 1.0);
  std::bernoulli_distribution prescribes(prescribed);
  const FlatReference start = moving(random, 1.0, 1.0);
  std::vector<Waypoint> waypoints = random_waypoints(random, n, 3.0);
  for (Waypoint& w : waypoints) {
    if (prescribes(random)) w.velocity = Eigen::Vector3d(u(random), u(random), u(random));
    if (prescribes(random)) w.acceleration = Eigen::Vector3d(u(random), u(random), u(random));
  }
  std::vector<double> T(static_cast<std::size_t>(n));
  for (double& t : T) t = duration(random);
  const auto trajectory = minimum_snap(Time{}, start, waypoints, T);
  ASSERT_TRUE(trajectory.ok());
  double cost = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<End> ends;
    for (const Waypoint& w : waypoints) {
      ends.push_back({w.position[axis]});
      if (w.velocity) ends.back().velocity = (*w.velocity)[axis];
      if (w.acceleration) ends.back().acceleration = (*w.acceleration)[axis];
    }
    const DenseMinimum expected = dense_minimum(
        T, {start.position[axis], start.velocity[axis], start.acceleration[axis], start.jerk[axis]},
        ends);
    cost += expected.cost;
    for (int p = 0; p < n; ++p) {
      const auto& segment = trajectory->segments()[static_cast<std::size_t>(p)];
      for (const double s : {0.1, 0.35, 0.5, 0.8}) {
        double value = 0.0;
        for (int i = 7; i >= 0; --i) value = value * s + expected.coefficients[8 * p + i];
        ASSERT_NEAR(derivative(segment, axis, s, 0), value, 1e-8) << n << " piece " << p;
      }
    }
  }
  ASSERT_NEAR(snap_cost(*trajectory), cost, 1e-6 * cost);
}

TEST(MinimumSnap, IsTheMinimumThatADenseSolutionFinds) {
  std::mt19937 random(1);
  for (int n = 1; n <= 6; ++n) {
    for (int trial = 0; trial < 10; ++trial) expect_dense_minimum(random, n, 0.0);
  }
}

TEST(MinimumSnap, IsTheMinimumWithPrescribedVelocitiesAndAccelerations) {
  std::mt19937 random(7);
  for (int n = 1; n <= 6; ++n) {
    for (int trial = 0; trial < 10; ++trial) expect_dense_minimum(random, n, 0.5);
  }
}

TEST(MinimumSnap, PassesWaypointsAsTheyPrescribe) {
  std::mt19937 random(8);
  std::vector<Waypoint> waypoints = random_waypoints(random, 4, 3.0);
  waypoints[0].velocity = Eigen::Vector3d(1.0, -0.5, 0.2);
  waypoints[1].acceleration = Eigen::Vector3d(0.3, 0.4, -0.2);
  waypoints[3].velocity = Eigen::Vector3d(0.0, 0.7, 0.0);
  const auto trajectory = minimum_snap(Time{}, at_rest({0, 0, 1}), waypoints, {1.5, 2.0, 1.0, 2.0});
  ASSERT_TRUE(trajectory.ok());
  const auto& segments = trajectory->segments();
  const auto at = [&](std::size_t piece, double s, int order) {
    return Eigen::Vector3d(derivative(segments[piece], kX, s, order),
                           derivative(segments[piece], kY, s, order),
                           derivative(segments[piece], kZ, s, order));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((at(i, 1.0, 0) - waypoints[i].position).norm(), 1e-9);
  }
  EXPECT_LT((at(0, 1.0, 1) - *waypoints[0].velocity).norm(), 1e-9);
  EXPECT_LT((at(1, 1.0, 2) - *waypoints[1].acceleration).norm(), 1e-9);
  // The last keeps what it prescribes, and the other derivatives are zero.
  EXPECT_LT((at(3, 1.0, 1) - *waypoints[3].velocity).norm(), 1e-9);
  EXPECT_LT(at(3, 1.0, 2).norm() + at(3, 1.0, 3).norm(), 1e-9);
  // Free derivatives are continuous, and what goes with a prescribed one is where it bends.
  for (std::size_t knot = 0; knot < 3; ++knot) {
    const int bends = knot == 0 ? 6 : knot == 1 ? 5 : -1;
    for (int order = 0; order <= 6; ++order) {
      const Eigen::Vector3d before = at(knot, 1.0, order), after = at(knot + 1, 0.0, order);
      const double jump = (before - after).norm() / (1.0 + before.norm());
      if (order == bends) {
        EXPECT_GT(jump, 1e-3) << "knot " << knot << " order " << order;
      } else {
        EXPECT_LT(jump, 1e-9) << "knot " << knot << " order " << order;
      }
    }
  }
  // Yaw knows nothing of it.
  std::vector<Waypoint> free = waypoints;
  for (Waypoint& w : free) w.velocity = w.acceleration = {};
  const auto other = minimum_snap(Time{}, at_rest({0, 0, 1}), free, {1.5, 2.0, 1.0, 2.0});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(derivative(segments[i], kYaw, 0.3, 0),
                derivative(other->segments()[i], kYaw, 0.3, 0), 1e-12);
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

/// The scale of a derivative on a piece.
double largest(const TrajectorySegment& segment, int axis, int order) {
  double most = 0.0;
  for (int i = 0; i <= 20; ++i) {
    most = std::max(most, std::abs(derivative(segment, axis, i / 20.0, order)));
  }
  return most;
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
          const double scale =
              largest(segments[i], axis, order) + largest(segments[i + 1], axis, order) + 1e-3;
          ASSERT_NEAR(derivative(segments[i], axis, 1.0, order),
                      derivative(segments[i + 1], axis, 0.0, order), 1e-9 * scale)
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

}  // namespace
}  // namespace swiftlet
