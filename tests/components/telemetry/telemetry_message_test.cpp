// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/telemetry/telemetry_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "components/conversions.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/utf8.hpp"
#include "components/telemetry/health_summary.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace flag = swiftlet_msgs::msg::Telemetry_Constants;
namespace level = diagnostic_msgs::msg::DiagnosticStatus_Constants;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Characters of one to four bytes.
std::string random_text(std::mt19937& random, std::size_t characters) {
  const char* const alphabet[] = {"a", " ", "ß", "é", "€", "飛", "🚁", "𝄞"};
  std::string text;
  while (characters-- > 0) text += alphabet[random() % std::size(alphabet)];
  return text;
}

bool is_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    if (i + length > text.size() || (lead >= 0x80 && lead < 0xC2)) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return false;
    }
    i += length;
  }
  return true;
}

/// Any number that a double can be.
double random_number(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  double number = 0.0;
  static_assert(sizeof(number) == sizeof(bits));
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

TEST(TelemetryMessage, IsAtMost200BytesWhateverTheContent) {
  std::mt19937 random(7);
  std::mt19937_64 bits(8);
  std::size_t longest = 0;
  for (int i = 0; i < 20'000; ++i) {
    swiftlet_msgs::msg::VehicleStatus status;
    status.mode(static_cast<std::uint8_t>(random()));
    status.height(random_number(bits));
    status.reason(random_text(random, random() % 400));
    nav_msgs::msg::Odometry odometry;
    odometry.pose().pose().position().x(random_number(bits));
    odometry.pose().pose().orientation().w(random() % 2 == 0 ? 1.0 : random_number(bits));
    sensor_msgs::msg::NavSatFix fix;
    fix.latitude(random_number(bits));
    fix.altitude(random_number(bits));
    swiftlet_msgs::msg::GuardStatus guard;
    guard.acting(random() % 2 == 0);
    guard.reason(random_text(random, random() % 400));
    VehicleKnowledge known;
    if (random() % 4 != 0) known.status = &status;
    if (random() % 4 != 0) known.odometry = &odometry;
    if (random() % 4 != 0) known.fix = &fix;
    if (random() % 4 != 0) known.guard = &guard;
    known.time_left = random_number(bits);
    const auto message = make_telemetry(Time(from_seconds(i)), known);
    const Cdr cdr = to_cdr(message);
    ASSERT_LE(cdr.size(), kTelemetryBytes);
    longest = std::max(longest, cdr.size());
    ASSERT_TRUE(is_utf8(message.reason())) << message.reason();
    const auto back = from_cdr<swiftlet_msgs::msg::Telemetry>(cdr);
    ASSERT_TRUE(back.ok());
    ASSERT_EQ(to_cdr(*back), cdr);
    const std::string& whole = known.guard != nullptr && guard.acting() ? guard.reason()
                               : known.status != nullptr                ? status.reason()
                                                         : "no vehicle/status is heard";
    ASSERT_EQ(whole.compare(0, message.reason().size(), message.reason()), 0);
    if (message.reason().size() < whole.size()) {
      ASSERT_GT(cdr.size(), kTelemetryBytes - 4) << "no more was cut than had to be";
    }
    const bool known_position = (message.flags() & flag::POSITION_KNOWN) != 0;
    ASSERT_EQ(std::isnan(message.attitude()[0]), !known_position);
  }
  EXPECT_EQ(longest, kTelemetryBytes);
}

TEST(Utf8, WhatIsNoUtf8IsCutWhereItFalls) {
  EXPECT_EQ(utf8_cut(std::string(300, '\x80'), 99), 99u);
  EXPECT_EQ(utf8_cut("ab", 99), 2u);
  EXPECT_EQ(utf8_cut("a\u20ac", 3), 1u);
  EXPECT_EQ(utf8_cut("\u20ac", 0), 0u);
}

TEST(TelemetryMessage, SaysWhatIsKnownInItsUnits) {
  const Eigen::Vector3d angles(0.1, -0.2, 2.5);
  RigidBodyState state;
  state.p_WB = {1.0, 2.0, 3.0};
  state.q_WB = Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
               Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
               Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
  state.v_WB_W = {0.4, -0.5, 0.6};
  const auto odometry = to_odometry(Time(1s), state);
  swiftlet_msgs::msg::VehicleStatus status;
  status.mode(swiftlet_msgs::msg::VehicleStatus_Constants::HOVER);
  status.armed(true);
  status.height(1.25);
  status.reason("1.20 m reached");
  sensor_msgs::msg::BatteryState battery;
  battery.percentage(0.75f);
  battery.voltage(15.5f);
  sensor_msgs::msg::NavSatFix fix;
  fix.latitude(47.397742);
  fix.longitude(8.545594);
  fix.altitude(488.0);
  swiftlet_msgs::msg::MissionState mission;
  mission.state(swiftlet_msgs::msg::MissionState_Constants::FLYING);
  mission.item(3);
  mission.count(70'000);
  VehicleKnowledge known;
  known.status = &status;
  known.odometry = &odometry;
  known.battery = &battery;
  known.fix = &fix;
  known.mission = &mission;
  known.time_left = 432.0;
  const auto message = make_telemetry(Time(1500ms), known);
  EXPECT_EQ(message.stamp().nanosec(), 500'000'000u);
  EXPECT_EQ(message.mode(), status.mode());
  EXPECT_EQ(message.flags(), flag::ARMED | flag::POSITION_KNOWN | flag::GLOBAL_POSITION_KNOWN |
                                 flag::MISSION_FLYING | flag::BATTERY_KNOWN);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    EXPECT_FLOAT_EQ(message.position()[i], static_cast<float>(state.p_WB[axis]));
    EXPECT_NEAR(message.velocity()[i], state.v_WB_W[axis], 1e-6) << "in the map";
    EXPECT_NEAR(message.attitude()[i], angles[axis], 1e-6);
  }
  EXPECT_FLOAT_EQ(message.height(), 1.25f);
  EXPECT_FLOAT_EQ(message.battery(), 0.75f);
  EXPECT_FLOAT_EQ(message.voltage(), 15.5f);
  EXPECT_FLOAT_EQ(message.time_left(), 432.0f);
  EXPECT_EQ(message.latitude(), 47.397742);
  EXPECT_EQ(message.longitude(), 8.545594);
  EXPECT_EQ(message.item(), 3);
  EXPECT_EQ(message.item_count(), 0xffff) << "more than it can say";
  EXPECT_EQ(message.reason(), "1.20 m reached");
}

TEST(TelemetryMessage, WhatIsNotKnownIsNanAndHasNoFlag) {
  const auto nothing = make_telemetry(Time(1s), {});
  EXPECT_EQ(nothing.flags(), 0);
  EXPECT_EQ(nothing.mode(), kUnknownMode);
  EXPECT_EQ(nothing.claw(), 0);
  for (const float value :
       {nothing.battery(), nothing.voltage(), nothing.time_left(), nothing.position()[2],
        nothing.velocity()[1], nothing.attitude()[0], nothing.height(), nothing.altitude()}) {
    EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_TRUE(std::isnan(nothing.latitude()) && std::isnan(nothing.longitude()));

  // Heard, but of no use.
  nav_msgs::msg::Odometry odometry;
  odometry.pose().pose().position().y(kNan);
  odometry.pose().pose().orientation().w(1.0);
  sensor_msgs::msg::BatteryState battery;
  battery.percentage(std::numeric_limits<float>::quiet_NaN());
  battery.voltage(12.0f);
  sensor_msgs::msg::NavSatFix fix;
  fix.status().status(sensor_msgs::msg::NavSatStatus_Constants::STATUS_NO_FIX);
  VehicleKnowledge known;
  known.odometry = &odometry;
  known.battery = &battery;
  known.fix = &fix;
  const auto useless = make_telemetry(Time(1s), known);
  EXPECT_EQ(useless.flags(), 0);
  EXPECT_TRUE(std::isnan(useless.position()[0]) && std::isnan(useless.attitude()[2]));
  EXPECT_TRUE(std::isnan(useless.battery()) && std::isnan(useless.latitude()));
  EXPECT_FLOAT_EQ(useless.voltage(), 12.0f);
}

TEST(HealthSummary, IsTheWorstAndStaleWhereSomebodyFellSilent) {
  const auto report = [](const char* name, std::uint8_t of_level) {
    diagnostic_msgs::msg::DiagnosticStatus status;
    status.name(name);
    status.level(of_level);
    diagnostic_msgs::msg::DiagnosticArray array;
    array.status({status});
    return array;
  };
  HealthSummary health;
  EXPECT_EQ(health.worst(Time(1s)), level::STALE) << "nobody said anything";
  health.hear(report("a", level::OK), Time(1s));
  EXPECT_EQ(health.worst(Time(1s)), level::OK);
  health.hear(report("b", level::ERROR), Time(1s));
  EXPECT_EQ(health.worst(Time(1s)), level::ERROR);
  health.hear(report("b", level::WARN), Time(2s));
  EXPECT_EQ(health.worst(Time(2s)), level::WARN) << "the last word counts";
  health.hear(report("b", level::OK), Time(5s));
  EXPECT_EQ(health.worst(Time(5s)), level::STALE) << "a was heard four seconds ago";
}

}  // namespace
}  // namespace swiftlet
