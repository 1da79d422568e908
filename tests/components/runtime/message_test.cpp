// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/message.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "all_messages.hpp"
#include "tests/components/runtime/reflection/random_message.hpp"

namespace swiftlet {
namespace {

TEST(Message, NamesAreThoseOfRos2) {
  const MessageType& type = message_type<sensor_msgs::msg::Imu>();
  EXPECT_EQ(type.name(), "sensor_msgs/msg/Imu");
  EXPECT_EQ(type.dds_name(), "sensor_msgs::msg::dds_::Imu_");
  EXPECT_EQ(find_message_type("sensor_msgs/msg/Imu"), &type);
  EXPECT_EQ(find_message_type("sensor_msgs::msg::dds_::Imu_"), &type);
  EXPECT_EQ(find_message_type("sensor_msgs/msg/Imv"), nullptr);
}

TEST(Message, NamesConvertBothWaysForAllTypes) {
  std::set<std::string> names;
  for (const MessageType* type : message_types()) {
    EXPECT_EQ(ros_type_name(type->dds_name()), type->name());
    EXPECT_EQ(dds_type_name(type->name()), type->dds_name());
    names.insert(type->name());
  }
  EXPECT_EQ(names.size(), message_types().size());
}

TEST(Message, CdrIsLaidOutByTheRules) {
  // XCDR1, little endian: long, unsigned long, string with length and terminating zero.
  std_msgs::msg::Header header;
  header.stamp().sec(1);
  header.stamp().nanosec(2);
  header.frame_id("map");
  EXPECT_EQ(to_cdr(header),
            (Cdr{0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 'm', 'a', 'p', 0}));
}

TEST(Message, RoundTripKeepsEveryField) {
  sensor_msgs::msg::LaserScan scan;
  scan.header().frame_id("laser");
  scan.angle_min(-1.5f);
  scan.ranges({1.0f, 2.0f, 3.0f});
  const auto back = from_cdr<sensor_msgs::msg::LaserScan>(to_cdr(scan));
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(*back == scan);
}

/// The message's bytes when what was in memory before is `noise`.
template <class T>
Cdr serialized_over(std::uint8_t noise, const T& message) {
  const MessageType& type = message_type<T>();
  Cdr cdr(type.serialized_size(&message), noise);
  EXPECT_EQ(type.serialize(&message, cdr.data(), cdr.size()), cdr.size());
  return cdr;
}

template <class T>
void expect_same_bytes_always(const T& message) {
  EXPECT_EQ(serialized_over(0xFF, message), serialized_over(0x00, message))
      << message_type<T>().name();
}

TEST(Message, PaddingIsNotWhatHappenedToBeInMemory) {
  for (unsigned seed = 0; seed < 20; ++seed) {
#define SWIFTLET_MESSAGE(package, Name) \
  expect_same_bytes_always(test::random_message<package::msg::Name>(seed));
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  }
}

TEST(Message, NorIsItAroundLongData) {
  for (std::size_t length = 0; length < 9; ++length) {
    const std::string text(length, 'x');
    for (const std::size_t bytes : {0U, 30U, 300U, 301U, 302U, 303U, 304U, 100'000U}) {
      const std::vector<std::uint8_t> data(bytes, 7);
      sensor_msgs::msg::Image image;
      image.header().frame_id(text);
      image.encoding(text);
      image.data(data);
      expect_same_bytes_always(image);
      sensor_msgs::msg::PointCloud2 cloud;
      cloud.header().frame_id(text);
      cloud.data(data);
      expect_same_bytes_always(cloud);
      nav_msgs::msg::OccupancyGrid map;
      map.header().frame_id(text);
      map.data().resize(bytes);
      expect_same_bytes_always(map);
    }
  }
}

TEST(Message, ABufferThatIsTooSmallIsLeftAlone) {
  std_msgs::msg::Header header;
  header.frame_id("map");
  const MessageType& type = message_type<std_msgs::msg::Header>();
  Cdr bytes(type.serialized_size(&header), 0xFF);
  EXPECT_EQ(type.serialize(&header, bytes.data(), bytes.size() - 1), 0U);
  EXPECT_EQ(bytes, Cdr(bytes.size(), 0xFF));
}

TEST(Message, BrokenBytesAreRefusedNotTrusted) {
  sensor_msgs::msg::LaserScan scan;
  scan.ranges(std::vector<float>(50, 1.0f));
  const Cdr good = to_cdr(scan);
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Cdr cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(from_cdr<sensor_msgs::msg::LaserScan>(cut).ok()) << size;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    Cdr flipped = good;
    flipped[random() % flipped.size()] = static_cast<std::uint8_t>(random());
    (void)from_cdr<sensor_msgs::msg::LaserScan>(flipped);  // may fail, must not crash
  }
}

TEST(Message, WhatWasRefusedKeepsNoMemory) {
  // The number of segments stands at the end; behind it so many bytes that it could be true.
  swiftlet_msgs::msg::Trajectory trajectory;
  Cdr cdr = to_cdr(trajectory);
  constexpr std::size_t kBytes = 60'000;
  cdr[cdr.size() - 4] = kBytes & 0xFF;
  cdr[cdr.size() - 3] = kBytes >> 8 & 0xFF;
  cdr.resize(cdr.size() + kBytes);
  ASSERT_FALSE(message_type<swiftlet_msgs::msg::Trajectory>().deserialize(cdr.data(), cdr.size(),
                                                                          &trajectory));
  EXPECT_EQ(trajectory.segments().capacity(), 0U);
}

}  // namespace
}  // namespace swiftlet
