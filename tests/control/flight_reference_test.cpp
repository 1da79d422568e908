// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/flight_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

using Eigen::Vector3d;

const Time kStart(std::chrono::seconds(100));
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Time after(double seconds) {
  return kStart + from_seconds(seconds);
}

/// Each derivative is the derivative of the one before: by differences at many moments, and, so
/// that no jump hides between them, by the trapezoidal rule from each moment to the next.
void expect_consistent(const FlightReference& reference, double seconds) {
  constexpr double h = 1e-4;
  for (double t = h; t < seconds; t += 0.0097) {
    const FlatReference a = reference.at(after(t - h)), b = reference.at(after(t)),
                        c = reference.at(after(t + h));
    ASSERT_LT(((c.position - a.position) / (2 * h) - b.velocity).norm(), 1e-5) << t;
    ASSERT_LT(((c.velocity - a.velocity) / (2 * h) - b.acceleration).norm(), 2e-3) << t;
    // Jerk is bounded, so acceleration moves little in h; snap bounds the rest.
    ASSERT_LT(((c.acceleration - a.acceleration) / (2 * h) - b.jerk).norm(), 2e-2) << t;
    ASSERT_NEAR((c.yaw - a.yaw) / (2 * h), b.yaw_rate, 1e-5) << t;
    ASSERT_NEAR((c.yaw_rate - a.yaw_rate) / (2 * h), b.yaw_acceleration, 2e-3) << t;

    constexpr double dt = 0.0097;
    const FlatReference n = reference.at(after(t + dt));
    ASSERT_LT((n.position - b.position - dt / 2 * (b.velocity + n.velocity)).norm(), 1e-4) << t;
    ASSERT_LT((n.velocity - b.velocity - dt / 2 * (b.acceleration + n.acceleration)).norm(), 1e-3)
        << t;
    ASSERT_LT((n.acceleration - b.acceleration - dt / 2 * (b.jerk + n.jerk)).norm(), 0.05) << t;
  }
}

/// Snap agrees with jerk within pieces; between them it may step.
void expect_snap(const FlightReference& reference, double t) {
  constexpr double h = 1e-5;
  const Vector3d difference =
      (reference.at(after(t + h)).jerk - reference.at(after(t - h)).jerk) / (2 * h);
  EXPECT_LT((difference - reference.at(after(t)).snap).norm(), 1e-2) << t;
}

struct Peaks {
  double velocity = 0, acceleration = 0, jerk = 0, yaw_acceleration = 0;
};
Peaks peaks_of(const FlightReference& reference) {
  Peaks peaks;
  const double T = to_seconds(reference.end() - reference.start());
  for (int i = 0; i <= 2000; ++i) {
    const FlatReference r = reference.at(after(T * i / 2000));
    peaks.velocity = std::max(peaks.velocity, r.velocity.norm());
    peaks.acceleration = std::max(peaks.acceleration, r.acceleration.norm());
    peaks.jerk = std::max(peaks.jerk, r.jerk.norm());
    peaks.yaw_acceleration = std::max(peaks.yaw_acceleration, std::abs(r.yaw_acceleration));
  }
  return peaks;
}

TEST(FlightReferenceMove, GoesFromRestToRestWithinTheLimitsAndTouchesOne) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const Vector3d from(uniform(random), uniform(random), uniform(random));
    const double distance = std::pow(10.0, 1.5 * uniform(random));
    const Vector3d to =
        from + distance * Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    ReferenceLimits limits;
    limits.velocity = std::pow(10.0, 0.5 * uniform(random));
    limits.acceleration = std::pow(10.0, 0.5 * uniform(random));
    limits.jerk = std::pow(10.0, 0.5 + uniform(random));
    const auto move = FlightReference::move(kStart, from, to, 0.7, limits);
    ASSERT_TRUE(move);
    const double T = to_seconds(move->end() - move->start());
    expect_consistent(*move, T + 0.3);
    if (HasFatalFailure()) FAIL() << i;

    const FlatReference start = move->at(kStart), end = move->at(move->end());
    EXPECT_LT((start.position - from).norm(), 1e-12);
    EXPECT_EQ(start.velocity.norm() + start.acceleration.norm(), 0.0);
    EXPECT_EQ(end.position, to);
    EXPECT_EQ(end.velocity.norm() + end.acceleration.norm(), 0.0);
    EXPECT_EQ(end.yaw, 0.7);
    EXPECT_FALSE(move->finished(move->end() - std::chrono::nanoseconds(1)));
    EXPECT_TRUE(move->finished(move->end()));

    const Peaks peaks = peaks_of(*move);
    const double v = peaks.velocity / limits.velocity, a = peaks.acceleration / limits.acceleration,
                 j = peaks.jerk / limits.jerk;
    EXPECT_LE(std::max({v, a, j}), 1.0 + 1e-6);
    EXPECT_GT(std::max({v, a, j}), 0.99) << "slower than the limits allow";
    // On the straight line all the way.
    for (double t = 0; t < T; t += T / 17) {
      const Vector3d p = move->at(after(t)).position - from;
      EXPECT_LT(p.cross((to - from).normalized()).norm(), 1e-9);
    }
    expect_snap(*move, 0.1 * T);
    expect_snap(*move, 0.95 * T);
  }
}

TEST(FlightReferenceMove, ALongOneCruisesAtTheLimit) {
  ReferenceLimits limits;
  const auto move = FlightReference::move(kStart, Vector3d::Zero(), {20, 0, 0}, 0, limits);
  ASSERT_TRUE(move);
  // Two ramps of 1.875 V / a cover V times one of them; the rest is cruise.
  const double ramp = 1.875 * limits.velocity / limits.acceleration;
  EXPECT_NEAR(to_seconds(move->end() - move->start()), 20 / limits.velocity + ramp, 1e-6);
  EXPECT_NEAR(move->at(after(10)).velocity.x(), limits.velocity, 1e-12);
}

TEST(FlightReferenceMove, ToWhereItIsIsFinishedAtOnce) {
  const auto move = FlightReference::move(kStart, {1, 2, 3}, {1, 2, 3}, 0.5, {});
  ASSERT_TRUE(move);
  EXPECT_TRUE(move->finished(kStart));
  EXPECT_EQ(move->at(kStart).position, Vector3d(1, 2, 3));
}

TEST(FlightReferenceBrake, StartsAsItWasAndStopsWithinTheLimits) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const ReferenceLimits limits;
  for (int i = 0; i < 60; ++i) {
    const auto vector = [&](double scale) {
      return Vector3d(scale * Vector3d(uniform(random), uniform(random), uniform(random)));
    };
    FlatReference from;
    from.position = vector(5);
    from.velocity = vector(2);
    from.acceleration = vector(1.5);
    from.yaw = 3 * uniform(random);
    from.yaw_rate = uniform(random);
    from.yaw_acceleration = uniform(random);
    const auto brake = FlightReference::brake(kStart, from, limits);
    ASSERT_TRUE(brake);
    const FlatReference start = brake->at(kStart);
    EXPECT_LT((start.position - from.position).norm(), 1e-12);
    EXPECT_LT((start.velocity - from.velocity).norm(), 1e-12);
    EXPECT_LT((start.acceleration - from.acceleration).norm(), 1e-12);
    EXPECT_NEAR(start.yaw_rate, from.yaw_rate, 1e-12);
    const double T = to_seconds(brake->end() - brake->start());
    expect_consistent(*brake, T + 0.3);
    if (HasFatalFailure()) FAIL() << i;

    const FlatReference just_before = brake->at(brake->end() - std::chrono::microseconds(1));
    EXPECT_LT((just_before.position - brake->final().position).norm(), 1e-6);
    EXPECT_LT(just_before.velocity.norm() + just_before.acceleration.norm(), 1e-4);

    const Peaks peaks = peaks_of(*brake);
    EXPECT_LE(peaks.acceleration, std::max(limits.acceleration, from.acceleration.norm()) * 1.01);
    EXPECT_LE(peaks.jerk, limits.jerk * 1.01);
    EXPECT_LE(peaks.yaw_acceleration, limits.yaw_acceleration * 1.01);
    expect_snap(*brake, 0.4 * T);
  }
}

TEST(FlightReferenceBrake, FromSteadyFlightTakesTheTimeOfItsShape) {
  FlatReference from;
  from.velocity = {1.0, 0, 0};
  ReferenceLimits limits;
  limits.jerk = 1000;
  const auto brake = FlightReference::brake(kStart, from, limits);
  ASSERT_TRUE(brake);
  const double T = to_seconds(brake->end() - brake->start());
  const double shortest = 1.875 * 1.0 / limits.acceleration;
  EXPECT_GE(T, shortest * (1 - 1e-3));
  EXPECT_LE(T, shortest * 1.04);
  EXPECT_NEAR(brake->final().position.x(), 0.5 * T, 1e-9);
}

TEST(FlightReferenceBrake, AtRestItHolds) {
  FlatReference from;
  from.position = {1, 2, 3};
  from.yaw = 0.4;
  const auto brake = FlightReference::brake(kStart, from, {});
  ASSERT_TRUE(brake);
  EXPECT_TRUE(brake->finished(kStart));
  EXPECT_EQ(brake->at(after(1)).position, from.position);
  EXPECT_EQ(brake->at(after(1)).yaw, 0.4);
}

TEST(FlightReferenceHold, RestsForEver) {
  const auto hold = FlightReference::hold({1, 2, 3}, 0.4);
  ASSERT_TRUE(hold);
  for (const Time time : {Time::min(), Time{}, kStart, Time::max()}) {
    EXPECT_EQ(hold->at(time).position, Vector3d(1, 2, 3));
    EXPECT_EQ(hold->at(time).velocity.norm(), 0.0);
    EXPECT_EQ(hold->at(time).yaw, 0.4);
  }
}

TEST(FlightReference, UnusableInputIsRefusedWithAReason) {
  const Vector3d bad(0, kNan, 0), far(0, 0, 1e9), zero(Vector3d::Zero());
  EXPECT_FALSE(FlightReference::hold(bad, 0).ok());
  EXPECT_FALSE(FlightReference::hold(zero, kNan).ok());
  EXPECT_FALSE(FlightReference::move(kStart, bad, zero, 0, {}).ok());
  EXPECT_FALSE(FlightReference::move(kStart, zero, far, 0, {}).ok());
  ReferenceLimits limits;
  limits.jerk = 0.0;
  EXPECT_FALSE(FlightReference::move(kStart, zero, {1, 0, 0}, 0, limits).ok());
  EXPECT_FALSE(FlightReference::brake(kStart, {}, limits).ok());
  limits = {};
  limits.velocity = kNan;
  const auto refused = FlightReference::move(kStart, zero, {1, 0, 0}, 0, limits);
  ASSERT_FALSE(refused.ok());
  EXPECT_FALSE(refused.error().reason.empty());
  FlatReference from;
  from.velocity = {0, std::numeric_limits<double>::infinity(), 0};
  EXPECT_FALSE(FlightReference::brake(kStart, from, {}).ok());
  from.velocity = {1e3, -1e4, 0};
  from.acceleration = {1e4, 0, 0};
  const auto hard = FlightReference::brake(kStart, from, {});
  ASSERT_TRUE(hard.ok());
  EXPECT_TRUE(hard->final().position.allFinite());
}

}  // namespace
}  // namespace swiftlet
