// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/battery/discharge_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

constexpr double kPeriod = 0.2;  // [s]

Time at(double seconds) {
  return Time(from_seconds(seconds));
}

/// Feeds the charge of a battery over time, and looks at the estimate after each sample.
void watch(DischargeEstimate& estimate, double until, const std::function<double(double)>& charge,
           const std::function<void(double, std::optional<double>)>& look) {
  for (int k = 1; k * kPeriod <= until; ++k) {
    const double t = k * kPeriod;
    estimate.add(at(t), charge(t));
    look(t, estimate.time_left(at(t)));
  }
}

TEST(DischargeEstimate, AConstantDischargeGivesTheTimeThatIsLeft) {
  for (const double endurance : {300.0, 600.0, 1800.0}) {
    DischargeEstimate estimate;
    int known = 0;
    watch(
        estimate, 0.95 * endurance, [&](double t) { return 1.0 - t / endurance; },
        [&](double t, std::optional<double> left) {
          if (t < 30.0) {
            EXPECT_FALSE(left) << t;
          }
          if (t > 0.021 * endurance && t > 31.0) {
            ASSERT_TRUE(left) << t;
          }
          if (!left) return;
          ++known;
          EXPECT_NEAR(*left, endurance - t, 1e-3 * endurance) << t;
        });
    EXPECT_GT(known, 100);
  }
}

TEST(DischargeEstimate, AMonitorThatCountsInPercentAndNoiseDoNotMatterMuch) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (const bool noisy : {false, true}) {
    DischargeEstimate estimate;
    constexpr double kEndurance = 900.0;
    watch(
        estimate, 800.0,
        [&](double t) {
          const double charge = 1.0 - t / kEndurance;
          return noisy ? charge + noise(random) : std::floor(100.0 * charge) / 100.0;
        },
        [&](double t, std::optional<double> left) {
          if (t < 180.0) return;
          ASSERT_TRUE(left) << t;
          EXPECT_NEAR(*left, kEndurance - t, 0.1 * kEndurance) << t;
        });
  }
}

TEST(DischargeEstimate, ChargingRestAndNoiseGiveNone) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  const std::function<double(double)> charges[] = {
      [](double t) { return 0.2 + t / 7200.0; }, [](double) { return 0.7; },
      [&](double) { return 0.7 + noise(random); },
      [&](double t) { return 0.2 + t / 7200.0 + noise(random); },
      [](double) { return std::numeric_limits<double>::quiet_NaN(); }};
  for (const auto& charge : charges) {
    DischargeEstimate estimate;
    watch(estimate, 3600.0, charge,
          [](double t, std::optional<double> left) { EXPECT_FALSE(left) << t << ": " << *left; });
  }
}

TEST(DischargeEstimate, DoesNotJumpWhenTheLoadDoublesOrHalves) {
  for (const double factor : {2.0, 0.5}) {
    DischargeEstimate estimate;
    constexpr double kRate = 1.0 / 1200.0;
    std::optional<double> last;
    double final_left = 0.0;
    watch(
        estimate, 500.0,
        [&](double t) { return 1.0 - kRate * (t < 200.0 ? t : 200.0 + factor * (t - 200.0)); },
        [&](double t, std::optional<double> left) {
          if (last) {
            ASSERT_TRUE(left) << t;
            // A fifth of a second further, by at most two percent.
            EXPECT_NEAR(*left, *last, 0.02 * *last) << t;
          }
          last = left;
          final_left = left.value_or(0.0);
        });
    const double charge = 1.0 - kRate * (200.0 + factor * 300.0);
    EXPECT_NEAR(final_left, charge / (factor * kRate), 0.1 * charge / (factor * kRate));
  }
}

TEST(DischargeEstimate, AnotherBatteryOrASilenceBeginsAnew) {
  DischargeEstimate estimate;
  const auto discharge = [](double t) { return 1.0 - t / 600.0; };
  const auto ignore = [](double, std::optional<double>) {};
  watch(estimate, 100.0, discharge, ignore);
  ASSERT_TRUE(estimate.time_left(at(100.0)));
  EXPECT_FALSE(estimate.time_left(at(111.0))) << "nothing was heard for 11 s";
  estimate.add(at(111.0), discharge(111.0));
  EXPECT_FALSE(estimate.time_left(at(111.0)));

  DischargeEstimate changed;
  watch(changed, 100.0, discharge, ignore);
  changed.add(at(100.2), 1.0);
  EXPECT_FALSE(changed.time_left(at(100.2)));
}

TEST(DischargeEstimate, AnEmptyBatteryHasNoTimeLeft) {
  DischargeEstimate estimate;
  std::optional<double> last;
  watch(
      estimate, 70.0, [](double t) { return std::max(0.0, 0.1 - t / 600.0); },
      [&](double, std::optional<double> left) { last = left; });
  ASSERT_TRUE(last);
  EXPECT_GE(*last, 0.0);
  EXPECT_LT(*last, 2.0);
}

}  // namespace
}  // namespace swiftlet
