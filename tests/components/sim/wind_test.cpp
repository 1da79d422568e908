// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/wind.hpp"

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using std::chrono::milliseconds;

TEST(Wind, WithoutGustsBlowsSteadily) {
  Wind::Params params;
  params.mean = {1.0, -2.0, 0.3};
  Wind wind(params, RandomStream(1, "wind"));
  for (int i = 0; i < 100; ++i) {
    wind.step(milliseconds(1));
    EXPECT_EQ(wind.velocity(), params.mean);
  }
}

TEST(Wind, GustsHaveTheirIntensityAndTimeConstantWhateverTheStep) {
  Wind::Params params;
  params.mean = {3.0, 0.0, 0.0};
  params.gust_intensity = {0.8, 0.4, 0.0};
  params.gust_time_constant = 0.5;
  for (const int step_ms : {5, 50}) {
    Wind wind(params, RandomStream(2, "wind"));
    std::vector<double> gust;
    for (int i = 0; i < 10000000 / step_ms / 5; ++i) {
      wind.step(milliseconds(step_ms));
      gust.push_back(wind.velocity().x() - 3.0);
      ASSERT_EQ(wind.velocity().z(), 0.0);
    }
    EXPECT_NEAR(std::sqrt(test::variance(gust)), 0.8, 0.05) << step_ms;
    EXPECT_NEAR(test::autocorrelation(gust, 500 / step_ms), std::exp(-1.0), 0.06) << step_ms;
  }
}

}  // namespace
}  // namespace swiftlet
