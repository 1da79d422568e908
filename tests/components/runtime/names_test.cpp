// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/names.hpp"

#include <gtest/gtest.h>

namespace swiftlet {
namespace {

TEST(Names, FollowTheRulesOfRos2) {
  for (const char* good : {"imu0", "range/down", "_private", "a/b_c/d9"}) {
    EXPECT_TRUE(check_name(good).ok()) << good;
  }
  for (const char* bad : {"", "/imu", "imu/", "a//b", "0imu", "a/0b", "a b", "a-b", "é"}) {
    EXPECT_FALSE(check_name(bad).ok()) << bad;
  }
}

TEST(Names, WireTopicAndBack) {
  EXPECT_EQ(wire_topic("", "imu0"), "rt/imu0");
  EXPECT_EQ(wire_topic("uav1", "range/down"), "rt/uav1/range/down");
  EXPECT_EQ(topic_of("uav1", "rt/uav1/range/down"), "range/down");
  EXPECT_EQ(topic_of("uav1", "rt/uav2/imu0"), "uav2/imu0");
  EXPECT_EQ(topic_of("", "rt/imu0"), "imu0");
  EXPECT_EQ(topic_of("", "ros_discovery_info"), "ros_discovery_info");
}

}  // namespace
}  // namespace swiftlet
