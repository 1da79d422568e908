// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/report/event_log.hpp"
#include "components/report/html_text.hpp"
#include "components/report/topic_health.hpp"

namespace swiftlet {
namespace {

std::string encoded(const std::string& text) {
  return html::base64({text.begin(), text.end()});
}

TEST(TopicHealth, FindsTheGapAndCountsSilences) {
  TopicWatch watch("scan", "sensor_msgs/msg/LaserScan");  // promised every 0.1 s
  for (int i = 0; i < 100; ++i) {
    if (i >= 40 && i < 46) continue;
    const auto silence = watch.add(0.1 * i);
    EXPECT_EQ(silence.has_value(), i == 46) << i;
  }
  const TopicHealth health = watch.finish(10.0);
  EXPECT_TRUE(health.is_sensor);
  EXPECT_EQ(health.messages, 94U);
  EXPECT_NEAR(health.largest_gap, 0.7, 1e-9);
  EXPECT_NEAR(health.largest_gap_at, 3.9, 1e-9);
  EXPECT_EQ(health.silences, 1U);
  EXPECT_NEAR(health.rate_hz(), 93.0 / 9.9, 1e-9);
  EXPECT_TRUE(health.too_slow());
}

TEST(TopicHealth, SensorThatDiesIsSilentUntilTheEnd) {
  TopicWatch watch("imu0", "sensor_msgs/msg/Imu");
  for (int i = 0; i < 1000; ++i) watch.add(0.001 * i);
  EXPECT_EQ(watch.finish(1.0).silences, 0U);
  const TopicHealth health = watch.finish(20.0);
  EXPECT_FALSE(health.too_slow());
  EXPECT_EQ(health.silences, 1U);
  EXPECT_NEAR(health.largest_gap, 19.001, 1e-9);
}

TEST(TopicHealth, TopicWithoutAPromiseIsNeverLate) {
  TopicWatch watch("path", "nav_msgs/msg/Path");
  watch.add(0.0);
  watch.add(50.0);
  const TopicHealth health = watch.finish(100.0);
  EXPECT_FALSE(health.too_slow());
  EXPECT_EQ(health.silences, 0U);
  EXPECT_DOUBLE_EQ(health.largest_gap, 50.0);
}

TEST(EventLog, IsBoundedAndSaysWhatIsLeftOut) {
  EventLog log;
  for (int i = 1000; i > 0; --i) log.add(i, FlightEvent::Level::kWarning, "flapping", "up");
  log.add(0.5, FlightEvent::Level::kInfo, "mode", "seen");
  EXPECT_EQ(log.sorted().size(), EventLog::kMostOfAKind + 1);
  EXPECT_EQ(log.sorted().front().text, "seen");
  EXPECT_EQ(log.left_out().at("flapping"), 1000 - EventLog::kMostOfAKind);
}

TEST(HtmlText, MarkupBecomesText) {
  EXPECT_EQ(html::escaped("<script>alert('&\"')</script>"),
            "&lt;script&gt;alert(&#39;&amp;&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(html::escaped("3 → 4 m²"), "3 → 4 m²");
}

TEST(HtmlText, ReplacesWhatIsNoUtf8AndWhatSteersTerminals) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(html::escaped("a\xFFz"), "a" + replaced + "z");
  EXPECT_EQ(html::escaped("\xC0\xBC"), replaced + replaced);                 // an overlong '<'
  EXPECT_EQ(html::escaped("\xED\xA0\x80"), replaced + replaced + replaced);  // a surrogate
  EXPECT_EQ(html::escaped("\xE2\x86"), replaced + replaced);                 // cut off
  EXPECT_EQ(html::escaped("\x1B[2J"), replaced + "[2J");
}

TEST(HtmlText, Base64OfTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(html::base64({0xFB, 0xEF, 0xFF}), "++//");
}

}  // namespace
}  // namespace swiftlet
