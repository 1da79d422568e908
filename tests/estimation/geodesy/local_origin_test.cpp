// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geodesy/local_origin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace swiftlet {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const GlobalPosition kZurich{47.397742, 8.545594, 488.0};

/// The ellipsoid's radii of curvature say how many metres a degree has: another way than the
/// library's.
Eigen::Vector3d metres(const GlobalPosition& origin, const GlobalPosition& place) {
  constexpr double kA = 6378137.0, kE2 = 6.69437999014e-3, kDegree = M_PI / 180.0;
  const double sine = std::sin(origin.latitude * kDegree);
  const double w = std::sqrt(1.0 - kE2 * sine * sine);
  const double meridian = kA * (1.0 - kE2) / (w * w * w), prime = kA / w;
  return {(place.longitude - origin.longitude) * kDegree * (prime + origin.altitude) *
              std::cos(origin.latitude * kDegree),
          (place.latitude - origin.latitude) * kDegree * (meridian + origin.altitude),
          place.altitude - origin.altitude};
}

TEST(LocalOrigin, IsEastNorthUp) {
  const LocalOrigin origin(kZurich);
  for (const auto& [dlat, dlon, dalt] :
       {std::array{1e-4, 0.0, 0.0}, {0.0, 1e-4, 0.0}, {0.0, 0.0, 7.0}, {-3e-4, 5e-4, 2.0}}) {
    const GlobalPosition place{kZurich.latitude + dlat, kZurich.longitude + dlon,
                               kZurich.altitude + dalt};
    EXPECT_LT((origin.to_map(place) - metres(kZurich, place)).norm(), 2e-3);
  }
}

TEST(LocalOrigin, ThereAndBackIsTheSamePlace) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const LocalOrigin origin({89.0 * share(random), 180.0 * share(random), 3000.0 * share(random)});
    const Eigen::Vector3d p(1000.0 * share(random), 1000.0 * share(random), 100.0 * share(random));
    EXPECT_LT((origin.to_map(origin.to_global(p)) - p).norm(), 1e-6);
  }
}

TEST(OriginEstimate, FindsWhereTheMapIsFromFixesOnTheWay) {
  const LocalOrigin truth(kZurich);
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  OriginEstimate estimate;
  EXPECT_FALSE(estimate.origin().has_value());
  double needed = 0;
  for (int k = 0; k < 300; ++k) {
    const Eigen::Vector3d p(0.1 * k, 3.0 * std::sin(0.05 * k), 1.5);
    const Eigen::Vector3d error(2.0 * noise(random), 2.0 * noise(random), 3.0 * noise(random));
    estimate.add(truth.to_global(p + error), 2.0, p);
    if (!estimate.origin()) needed = k + 1;
  }
  EXPECT_NEAR(needed, 4, 1) << "four fixes of 2 m are one of 1 m";
  ASSERT_TRUE(estimate.origin().has_value());
  const Eigen::Vector3d off = truth.to_map(estimate.origin()->position());
  EXPECT_LT(off.head<2>().norm(), 4.0 * estimate.sigma());
  EXPECT_LT(estimate.sigma(), 0.25);
}

TEST(OriginEstimate, FollowsAMapThatDrifts) {
  const LocalOrigin truth(kZurich);
  OriginEstimate estimate;
  for (int k = 0; k < 200; ++k) estimate.add(kZurich, 1.0, Eigen::Vector3d::Zero());
  for (int k = 0; k < 500; ++k) estimate.add(kZurich, 1.0, Eigen::Vector3d(3.0, 0.0, 0.0));
  EXPECT_NEAR(truth.to_map(estimate.origin()->position()).x(), -3.0, 0.05);
}

TEST(OriginEstimate, IgnoresWhatIsNoPlaceOnEarth) {
  OriginEstimate estimate;
  const Eigen::Vector3d here = Eigen::Vector3d::Zero();
  estimate.add({kNan, 8.5, 488.0}, 1.0, here);
  estimate.add({97.0, 8.5, 488.0}, 1.0, here);
  estimate.add({47.0, 8.5, 1e9}, 1.0, here);
  estimate.add(kZurich, kNan, here);
  estimate.add(kZurich, -1.0, here);
  estimate.add(kZurich, 1.0, Eigen::Vector3d(kNan, 0.0, 0.0));
  EXPECT_FALSE(estimate.origin().has_value());
  EXPECT_TRUE(std::isinf(estimate.sigma()));
  estimate.add(kZurich, 0.0, here);
  ASSERT_TRUE(estimate.origin().has_value());
  EXPECT_NEAR(estimate.origin()->position().latitude, kZurich.latitude, 1e-9);
}

}  // namespace
}  // namespace swiftlet
