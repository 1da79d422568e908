// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/cloud_collector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "components/conversions.hpp"
#include "components/surroundings/cloud_message.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Time kNow(100s);

nav_msgs::msg::Odometry odometry(Time time, const Eigen::Vector3d& position, double yaw = 0.0) {
  RigidBodyState state;
  state.p_WB = position;
  state.q_WB = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  return to_odometry(time, state);
}

tf2_msgs::msg::TFMessage mount(const std::string& frame, const Eigen::Vector3d& place) {
  tf2_msgs::msg::TFMessage message;
  message.transforms().push_back(
      to_transform(Time{}, "base_link", frame, {place, Eigen::Quaterniond::Identity()}));
  return message;
}

/// One beam ahead, 2 m long.
sensor_msgs::msg::LaserScan beam_ahead(Time time) {
  sensor_msgs::msg::LaserScan scan;
  scan.header(make_header(time, "laser"));
  scan.angle_increment(0.1F);
  scan.range_min(0.1F);
  scan.range_max(10.0F);
  scan.ranges({2.0F});
  return scan;
}

/// x, y, z as float32 or float64, with something between them, as drivers send it.
sensor_msgs::msg::PointCloud2 cloud_of(const std::vector<Eigen::Vector3d>& points,
                                       const std::string& frame, bool doubles = false) {
  const std::uint32_t size = doubles ? 8 : 4;
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header(make_header(kNow, frame));
  cloud.height(1);
  cloud.width(static_cast<std::uint32_t>(points.size()));
  cloud.point_step(2 + 4 * size);
  cloud.row_step(cloud.point_step() * cloud.width() + 3);
  cloud.data().resize(cloud.row_step());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[axis]));
    field.offset(2 + static_cast<std::uint32_t>(axis + 1) * size);
    field.datatype(doubles ? sensor_msgs::msg::PointField_Constants::FLOAT64
                           : sensor_msgs::msg::PointField_Constants::FLOAT32);
    field.count(1);
    cloud.fields().push_back(field);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::uint8_t* at = cloud.data().data() + i * cloud.point_step() + field.offset();
      const double wide = points[i][static_cast<Eigen::Index>(axis)];
      const auto narrow = static_cast<float>(wide);
      if (doubles) {
        std::memcpy(at, &wide, sizeof(wide));
      } else {
        std::memcpy(at, &narrow, sizeof(narrow));
      }
    }
  }
  return cloud;
}

TEST(PointsOfCloud, AreThoseThatWereSent) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> points{{1.5, -2.25, 3.0}, {0.0, none, 0.0}, {-4.0, 5.0, 6.5}};
  for (const bool doubles : {false, true}) {
    const auto read = points_of(cloud_of(points, "map", doubles));
    ASSERT_TRUE(read.ok()) << read.error().reason;
    ASSERT_EQ(read->size(), 2u) << "the one without a number is left out";
    EXPECT_EQ((*read)[0], points[0]);
    EXPECT_EQ((*read)[1], points[2]);
  }
  EXPECT_TRUE(points_of(cloud_of({}, "map"))->empty());
}

TEST(PointsOfCloud, ContradictionsAreRefused) {
  const auto why = [](const sensor_msgs::msg::PointCloud2& cloud) {
    const auto points = points_of(cloud);
    return points.ok() ? "" : points.error().reason;
  };
  const auto good = cloud_of({{1, 2, 3}, {4, 5, 6}}, "map");
  ASSERT_EQ(why(good), "");
  auto cloud = good;
  cloud.data().pop_back();
  EXPECT_THAT(why(cloud), HasSubstr("fewer bytes"));
  cloud = good;
  cloud.width(3);
  EXPECT_THAT(why(cloud), HasSubstr("fewer bytes"));
  cloud = good;
  cloud.height(4'000'000'000U);
  EXPECT_THAT(why(cloud), HasSubstr("fewer bytes"));
  cloud = good;
  cloud.row_step(0);
  EXPECT_THAT(why(cloud), HasSubstr("fewer bytes"));
  cloud = good;
  cloud.point_step(4);
  EXPECT_THAT(why(cloud), HasSubstr("behind the end of a point"));
  cloud = good;
  cloud.fields()[1].offset(0xFFFFFFFFU);
  EXPECT_THAT(why(cloud), HasSubstr("'y' lies behind"));
  cloud = good;
  cloud.fields()[2].name("depth");
  EXPECT_THAT(why(cloud), HasSubstr("no field 'z'"));
  cloud = good;
  cloud.fields()[0].datatype(sensor_msgs::msg::PointField_Constants::UINT16);
  EXPECT_THAT(why(cloud), HasSubstr("neither float32 nor float64"));
  cloud = good;
  cloud.is_bigendian(true);
  EXPECT_THAT(why(cloud), HasSubstr("big-endian"));
}

TEST(CloudCollector, AScanWaitsForItsOdometryAndIsPlacedByIt) {
  CloudCollector collector(0.05);
  collector.hear(mount("laser", {0.1, 0.0, 0.2}));
  collector.hear(odometry(kNow - 10ms, {1.0, 1.0, 1.0}, M_PI / 2));
  collector.hear(beam_ahead(kNow));
  EXPECT_EQ(collector.heard(), 1);
  EXPECT_EQ(collector.placed(), 0) << "where it was taken is not known yet";
  collector.hear(odometry(kNow + 10ms, {1.0, 3.0, 1.0}, M_PI / 2));
  EXPECT_EQ(collector.placed(), 1);
  ASSERT_EQ(collector.cloud().size(), 1u);
  // Half way between both, looking north: 0.1 m to the scanner, 2 m along the beam.
  EXPECT_LT((collector.cloud().points()[0] - Eigen::Vector3d(1.0, 2.0 + 2.1, 1.2)).norm(), 1e-6);
}

TEST(CloudCollector, ACloudInTheMapNeedsNoOdometryOneOfASensorDoes) {
  CloudCollector collector(0.05);
  collector.hear(cloud_of({{1, 2, 3}}, "map"));
  EXPECT_EQ(collector.placed(), 1);
  EXPECT_EQ(collector.cloud().points()[0], Eigen::Vector3d(1, 2, 3));
  collector.hear(cloud_of({{1, 0, 0}, {2, 0, 0}}, "depth"));
  EXPECT_EQ(collector.placed(), 1);
  collector.hear(mount("depth", {0.0, 0.0, 0.5}));
  collector.hear(odometry(kNow, {7.0, 0.0, 0.0}, M_PI));
  ASSERT_EQ(collector.cloud().size(), 3u);
  EXPECT_LT((collector.cloud().points()[2] - Eigen::Vector3d(5.0, 0.0, 0.5)).norm(), 1e-6);
}

TEST(CloudCollector, SaysWhyNothingCouldBePlaced) {
  CloudCollector collector(0.05);
  collector.hear(beam_ahead(kNow));
  EXPECT_THAT(collector.problem(), HasSubstr("no odometry is heard"));
  collector.hear(odometry(kNow - 10ms, {0, 0, 0}));
  EXPECT_THAT(collector.problem(), HasSubstr("has not come yet"));
  collector.hear(odometry(kNow + 10ms, {0, 0, 0}));
  EXPECT_THAT(collector.problem(), HasSubstr("where the sensor 'laser' sits on 'base_link'"));
  collector.hear(mount("laser", {0, 0, 0}));
  collector.hear(beam_ahead(kNow - 50s));
  EXPECT_THAT(collector.problem(), HasSubstr("do the clocks agree?"));
  EXPECT_EQ(collector.placed(), 0);
  EXPECT_EQ(collector.heard(), 2);
}

TEST(CloudCollector, WhatWaitsIsBounded) {
  CloudCollector collector(0.05);
  collector.hear(mount("laser", {0, 0, 0}));
  collector.hear(odometry(kNow, {0, 0, 0}));
  for (int i = 1; i <= 10'000; ++i) collector.hear(beam_ahead(kNow + 20ms));
  collector.hear(odometry(kNow + 30ms, {0, 0, 0}));
  EXPECT_EQ(collector.placed(), 50);
}

}  // namespace
}  // namespace swiftlet
