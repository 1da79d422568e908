// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/input_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr EndpointGuid kFirst{1};
constexpr EndpointGuid kSecond{2};

TEST(InputWatch, OneWriterIsHeardAtATime) {
  InputWatch watch("setpoint", 10ms);
  EXPECT_TRUE(watch.accept(kFirst, Time(0ms)));
  EXPECT_FALSE(watch.accept(kSecond, Time(5ms)));
  EXPECT_TRUE(watch.accept(kFirst, Time(30ms)));
  EXPECT_FALSE(watch.accept(kSecond, Time(60ms))) << "not silent for more than three periods";
  EXPECT_TRUE(watch.accept(kSecond, Time(61ms)));
  EXPECT_FALSE(watch.accept(kFirst, Time(62ms))) << "the first has lost its place";
}

TEST(InputWatch, ATopicWithoutPeriodIsHeardFromAnybody) {
  InputWatch watch("mode", 0ms);
  EXPECT_TRUE(watch.accept(kFirst, Time(0ms)));
  EXPECT_TRUE(watch.accept(kSecond, Time(0ms)));
  EXPECT_EQ(watch.problem(Time(10s), 0).text, "");
}

TEST(InputWatch, SaysWhatIsMissing) {
  InputWatch watch("scan", 100ms);
  EXPECT_THAT(watch.problem(Time(1s), 0).text, HasSubstr("nobody writes it"));
  EXPECT_THAT(watch.problem(Time(1s), 1).text, HasSubstr("has sent nothing"));
  watch.accept(kFirst, Time(1s));
  EXPECT_EQ(watch.problem(Time(1300ms), 1).text, "");
  EXPECT_THAT(watch.problem(Time(1310ms), 1).text, HasSubstr("silent for 0.31 s"));
}

/// What is said of a topic of 100 Hz that comes every `period`.
std::string problem_at(Duration period) {
  InputWatch watch("imu0", 10ms);
  Time status{};
  for (Time now{}; now < Time(3s); now += period) {
    watch.accept(kFirst, now);
    for (; status <= now; status += 200ms) watch.sample_rate(status);
  }
  return watch.problem(Time(3s), 1).text;
}

TEST(InputWatch, HalfTheRateIsTooSlow) {
  EXPECT_EQ(problem_at(10ms), "");
  EXPECT_EQ(problem_at(18ms), "");
  EXPECT_THAT(problem_at(25ms), HasSubstr("40 Hz, 100 Hz are usual"));
}

TEST(InputWatch, TheRateIsThatOfTheTimeSinceTheWriterSpeaks) {
  InputWatch watch("imu0", 10ms);
  const auto speak = [&](const EndpointGuid& writer, Time from, Time until) {
    for (Time now = from; now < until; now += 10ms) {
      watch.accept(writer, now);
      if (now.time_since_epoch() % 200ms == 0ms) watch.sample_rate(now);
      EXPECT_EQ(watch.problem(now, 1).text, "") << to_seconds(now);
    }
  };
  for (Time now{}; now < Time(3900ms); now += 200ms) watch.sample_rate(now);  // nobody is there yet
  speak(kFirst, Time(3900ms), Time(6s));
  for (Time now(6s); now < Time(6900ms); now += 200ms) watch.sample_rate(now);  // it was killed
  speak(kSecond, Time(6900ms), Time(9s));
}

}  // namespace
}  // namespace swiftlet
