// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/bernstein.hpp"

#include <gtest/gtest.h>

#include <random>

#include "planner/trajectory/enclosure.hpp"

namespace swiftlet {
namespace {

template <int N>
Coefficients<N> random_polynomial(std::mt19937& random) {
  std::uniform_real_distribution<double> coefficient(-3.0, 3.0);
  Coefficients<N> c;
  for (int i = 0; i < N; ++i) c[i] = coefficient(random);
  return c;
}

template <int N>
void expect_bounds(std::mt19937& random) {
  for (int trial = 0; trial < 200; ++trial) {
    const Coefficients<N> c = random_polynomial<N>(random);
    double least = horner(c, 0.0), most = least;
    for (int i = 0; i <= 2000; ++i) {
      least = std::min(least, horner(c, i / 2000.0));
      most = std::max(most, horner(c, i / 2000.0));
    }
    const double scale = 1.0 + std::max(std::abs(least), std::abs(most));
    ASSERT_GE(upper_bound(c), most - 1e-12 * scale) << N;
    ASSERT_LE(upper_bound(c), most + 1e-4 * scale) << N;
    ASSERT_LE(lower_bound(c), least + 1e-12 * scale) << N;
    ASSERT_GE(lower_bound(c), least - 1e-4 * scale) << N;
  }
}

TEST(Bernstein, BoundsAreTrueAndTakenForEveryDegree) {
  std::mt19937 random(1);
  expect_bounds<1>(random);
  expect_bounds<2>(random);
  expect_bounds<5>(random);
  expect_bounds<10>(random);
  expect_bounds<19>(random);
}

TEST(Bernstein, HalvesAreTheSamePolynomial) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const auto power = random_polynomial<10>(random);
    const auto [left, right] = bernstein_halves(to_bernstein(power));
    EXPECT_NEAR(left[0], horner(power, 0.0), 1e-12);
    EXPECT_NEAR(left[9], horner(power, 0.5), 1e-12);
    EXPECT_NEAR(right[0], horner(power, 0.5), 1e-12);
    EXPECT_NEAR(right[9], horner(power, 1.0), 1e-12);
    const auto [second, third] = bernstein_halves(left);
    EXPECT_NEAR(second[9], horner(power, 0.25), 1e-12);
    EXPECT_NEAR(third[0], horner(power, 0.25), 1e-12);
  }
}

TEST(Bernstein, AMaximumInsideIsFoundToTheTolerance) {
  // 4 s (1 - s), squared: 1 in the middle, with slope zero.
  Coefficients<5> c;
  c << 0, 0, 16, -32, 16;
  EXPECT_GE(upper_bound(c), 1.0);
  EXPECT_LE(upper_bound(c), 1.0 + 2 * kMaximumTolerance);
}

/// A function of t in [-1, 1] that an enclosure is of.
struct Function {
  Enclosure enclosure;
  std::function<double(double)> value;
};

void expect_encloses(const Function& f, const char* what) {
  for (int i = 0; i <= 200; ++i) {
    const double t = -1.0 + i / 100.0;
    const double off = std::abs(f.value(t) - f.enclosure.value - f.enclosure.slope * t);
    ASSERT_LE(off, f.enclosure.error + 1e-12 * (1.0 + std::abs(f.value(t)))) << what << " " << t;
  }
}

/// A polynomial on the part of [0, 1] around `middle` with the half width `reach`, which must be
/// a power of 2 that fits.
Function random_function(std::mt19937& random, int halvings) {
  auto c = random_polynomial<10>(random);
  Coefficients<10> b = to_bernstein(c);
  for (int k = 0; k < halvings; ++k) b = bernstein_halves(b).first;
  const double width = std::pow(0.5, halvings);
  return {enclose(b), [=](double t) { return horner(c, width * 0.5 * (t + 1.0)); }};
}

TEST(Enclosure, HoldsWhatTheFunctionsTake) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Function a = random_function(random, trial % 6), b = random_function(random, trial % 6);
    expect_encloses(a, "polynomial");
    expect_encloses({a.enclosure + b.enclosure, [&](double t) { return a.value(t) + b.value(t); }},
                    "sum");
    expect_encloses({a.enclosure - b.enclosure, [&](double t) { return a.value(t) - b.value(t); }},
                    "difference");
    expect_encloses({a.enclosure * b.enclosure, [&](double t) { return a.value(t) * b.value(t); }},
                    "product");
    expect_encloses({cosine(a.enclosure), [&](double t) { return std::cos(a.value(t)); }},
                    "cosine");
    expect_encloses({sine(a.enclosure), [&](double t) { return std::sin(a.value(t)); }}, "sine");
    const Function positive{a.enclosure * a.enclosure + Enclosure{20.0, 0.0, 0.0},
                            [&](double t) { return a.value(t) * a.value(t) + 20.0; }};
    if (positive.enclosure.lower() > 0.0) {
      expect_encloses(
          {inverse(positive.enclosure), [&](double t) { return 1 / positive.value(t); }},
          "inverse");
    }
  }
}

TEST(Enclosure, ErrorsShrinkToAQuarterWithTheInterval) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const auto seed = random();
    const auto error_after = [&](int halvings) {
      std::mt19937 same(seed);
      const Enclosure a = random_function(same, halvings).enclosure;
      const Enclosure b = random_function(same, halvings).enclosure;
      return (cosine(a) * b * inverse(b * b + Enclosure{2.0, 0.0, 0.0})).error;
    };
    EXPECT_LT(error_after(11), 0.3 * error_after(10));
  }
}

TEST(Enclosure, NothingIsKnownOfTheInverseOfWhatMayBeZero) {
  EXPECT_EQ(inverse(Enclosure{1.0, 1.0, 0.0}).upper(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(inverse(Enclosure{-3.0, 1.0, 0.0}).upper(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace swiftlet
