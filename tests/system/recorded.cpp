// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/recorded.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/writer.hpp"
#include "components/conversions.hpp"
#include "components/runtime/reflection/idl_schema.hpp"

namespace swiftlet::test {

std::map<std::string, std::vector<mcap::Bytes>> read_topics(const std::filesystem::path& file) {
  std::map<std::string, std::vector<mcap::Bytes>> topics;
  const auto reader = mcap::Reader::open(file);
  if (!reader.ok()) {
    ADD_FAILURE() << reader.error().reason;
    return topics;
  }
  auto messages = reader->messages();
  for (;;) {
    const auto next = messages.next();
    if (!next.ok()) {
      ADD_FAILURE() << next.error().reason;
      return topics;
    }
    if (!*next) return topics;
    topics[(*next)->channel->topic].push_back((*next)->message.data.copy());
  }
}

mcap::Bytes last_bytes(const std::filesystem::path& file, const std::string& topic) {
  const auto topics = read_topics(file);
  const auto found = topics.find(topic);
  if (found != topics.end()) return found->second.back();
  ADD_FAILURE() << file << " has no " << topic;
  return {};
}

namespace {

template <class T>
std::uint16_t add_channel(mcap::Writer& writer, const std::string& topic) {
  const std::string& type = message_type<T>().name();
  const std::string idl = idl_schema(type).value();
  const auto schema = writer.add_schema(type, "ros2idl", std::string_view(idl));
  return writer.add_channel(topic, "cdr", schema.value()).value();
}

template <class T>
void write_message(mcap::Writer& writer, std::uint16_t channel, Time time, const T& message) {
  const Cdr cdr = to_cdr(message);
  const mcap::Timestamp stamp = mcap::to_timestamp(time);
  ASSERT_TRUE(writer.write(mcap::Message{channel, 0, stamp, stamp, cdr}).ok());
}

sensor_msgs::msg::LaserScan round_room(Time time) {
  constexpr int kBeams = 90;
  sensor_msgs::msg::LaserScan scan;
  scan.header(make_header(time, "laser"));
  scan.angle_increment(static_cast<float>(2.0 * M_PI / kBeams));
  scan.angle_max(scan.angle_increment() * (kBeams - 1));
  scan.range_min(0.1F);
  scan.range_max(12.0F);
  scan.ranges(std::vector<float>(kBeams, 2.0F));
  return scan;
}

}  // namespace

void write_recording(const std::filesystem::path& file) {
  mcap::WriterParams params;
  params.profile = "ros2";
  params.overwrite = true;
  params.chunk_duration = std::chrono::milliseconds(500);
  auto writer = mcap::Writer::open(file, params);
  ASSERT_TRUE(writer.ok()) << writer.error().reason;
  const auto odometry = add_channel<nav_msgs::msg::Odometry>(*writer, "odometry");
  const auto scan = add_channel<sensor_msgs::msg::LaserScan>(*writer, "scan");
  for (int i = 0; i < 500; ++i) {
    const Time time = Time{} + std::chrono::milliseconds(1000 + 10 * i);
    RigidBodyState state;
    state.p_WB = {0.001 * i, 0.0, 1.0};
    auto message = to_odometry(time, state);
    message.child_frame_id("laser");  // that of the scanner itself: no tf_static is needed
    write_message(*writer, odometry, time, message);
    if (i % 10 == 5) write_message(*writer, scan, time, round_room(time));
  }
  ASSERT_TRUE(writer->close().ok());
}

}  // namespace swiftlet::test
