// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The recording of a flight in the eyes of Foxglove's own decoders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "all_messages.hpp"
#include "components/runtime/message.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/node_decoder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;

constexpr int kEvery = 7;  // values are compared of one message in so many

/// As decode.mjs prints numbers that JSON lacks.
json number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return value;
}

template <class Sequence>
json numbers(const Sequence& values) {
  json list = json::array();
  for (const auto value : values) list.push_back(number(static_cast<double>(value)));
  return list;
}

template <class Xyz>
json xyz(const Xyz& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

json xyzw(const geometry_msgs::msg::Quaternion& q) {
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

json of(const builtin_interfaces::msg::Time& time) {
  return {{"sec", time.sec()}, {"nsec", time.nanosec()}};
}

json of(const std_msgs::msg::Header& header) {
  return {{"stamp", of(header.stamp())}, {"frame_id", header.frame_id()}};
}

json of(const geometry_msgs::msg::Pose& pose) {
  return {{"position", xyz(pose.position())}, {"orientation", xyzw(pose.orientation())}};
}

json of(const sensor_msgs::msg::Imu& m) {
  return {{"header", of(m.header())},
          {"orientation", xyzw(m.orientation())},
          {"orientation_covariance", numbers(m.orientation_covariance())},
          {"angular_velocity", xyz(m.angular_velocity())},
          {"angular_velocity_covariance", numbers(m.angular_velocity_covariance())},
          {"linear_acceleration", xyz(m.linear_acceleration())},
          {"linear_acceleration_covariance", numbers(m.linear_acceleration_covariance())}};
}

json of(const sensor_msgs::msg::LaserScan& m) {
  return {{"header", of(m.header())},
          {"angle_min", number(m.angle_min())},
          {"angle_max", number(m.angle_max())},
          {"angle_increment", number(m.angle_increment())},
          {"time_increment", number(m.time_increment())},
          {"scan_time", number(m.scan_time())},
          {"range_min", number(m.range_min())},
          {"range_max", number(m.range_max())},
          {"ranges", numbers(m.ranges())},
          {"intensities", numbers(m.intensities())}};
}

json of(const nav_msgs::msg::Odometry& m) {
  return {{"header", of(m.header())},
          {"child_frame_id", m.child_frame_id()},
          {"pose", {{"pose", of(m.pose().pose())}, {"covariance", numbers(m.pose().covariance())}}},
          {"twist",
           {{"twist",
             {{"linear", xyz(m.twist().twist().linear())},
              {"angular", xyz(m.twist().twist().angular())}}},
            {"covariance", numbers(m.twist().covariance())}}}};
}

json of(const nav_msgs::msg::OccupancyGrid& m) {
  return {{"header", of(m.header())},
          {"info",
           {{"map_load_time", of(m.info().map_load_time())},
            {"resolution", number(m.info().resolution())},
            {"width", m.info().width()},
            {"height", m.info().height()},
            {"origin", of(m.info().origin())}}},
          {"data", numbers(m.data())}};
}

json of(const swiftlet_msgs::msg::VehicleStatus& m) {
  return {{"header", of(m.header())},
          {"mode", m.mode()},
          {"armed", m.armed()},
          {"ready", m.ready()},
          {"reason", m.reason()},
          {"height", m.height()},
          {"mission_id", m.mission_id()},
          {"waypoint", m.waypoint()},
          {"waypoint_count", m.waypoint_count()},
          {"mission_done", m.mission_done()},
          {"takeoff_point", xyz(m.takeoff_point())},
          {"station", m.station()}};
}

/// The value that our own reader gives for one message.
template <class T>
json ours(const mcap::Bytes& cdr) {
  return of(from_cdr<T>(cdr).value());
}

class NodeFlight : public test::SystemTest {};

TEST_F(NodeFlight, EveryMessageDecodesToTheValuesThatWeRead) {
  std::string reason;
  const auto decoder_folder = decoder(reason);
  if (decoder_folder.empty()) GTEST_SKIP() << reason;
  const std::string flight = path("flight.mcap");
  const test::Finished flown = run({"fly", test::hop(), "--record", flight});
  ASSERT_THAT(flown.out, testing::HasSubstr("recording  hash ")) << flown.err;

  const mcap::Reader reader = mcap::Reader::open(flight).value();
  const json theirs = decoded(decoder_folder, flight, kEvery);
  ASSERT_TRUE(theirs.is_object()) << "the decoders refused the recording";

  // Every message of every topic went through their decoder.
  EXPECT_EQ(theirs["statistics"]["messages"], reader.statistics().message_count);
  EXPECT_EQ(theirs["messages_from_the_front"], reader.statistics().message_count);
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [id, count] : reader.statistics().channel_message_counts) {
    counts[reader.channels().at(id).topic] += count;
  }
  EXPECT_EQ(theirs["decoded"].get<decltype(counts)>(), counts);
  EXPECT_GE(counts.size(), 18U);

  const std::map<std::string, std::function<json(const mcap::Bytes&)>> compared = {
      {"imu0", ours<sensor_msgs::msg::Imu>},
      {"scan", ours<sensor_msgs::msg::LaserScan>},
      {"odometry", ours<nav_msgs::msg::Odometry>},
      {"map", ours<nav_msgs::msg::OccupancyGrid>},
      {"vehicle/status", ours<swiftlet_msgs::msg::VehicleStatus>}};
  std::map<std::string, std::vector<mcap::Sample>> samples;
  for (mcap::Sample& sample : mcap::read_samples(reader)) {
    samples[sample.topic].push_back(std::move(sample));
  }
  std::map<std::string, std::size_t> seen;
  for (const json& message : theirs["messages"]) {
    const std::string topic = message["topic"];
    const mcap::Sample& sample = samples[topic].at(kEvery * seen[topic]++);
    EXPECT_EQ(message["log_time"], std::to_string(sample.log_time));
    EXPECT_EQ(message["sequence"], sample.sequence);
    const auto value = compared.find(topic);
    if (value == compared.end()) continue;
    ASSERT_EQ(message["value"], value->second(sample.data)) << topic << " at " << sample.log_time;
  }
  for (const auto& [topic, value] : compared) {
    EXPECT_GE(seen[topic], 5U) << topic << " was hardly compared";
  }
}

}  // namespace
}  // namespace swiftlet
