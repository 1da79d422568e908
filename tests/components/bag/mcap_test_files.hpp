// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/writer.hpp"

namespace swiftlet::mcap {

/// A message that owns its data, to compare what was written with what is read.
struct Sample {
  std::string topic;
  std::uint32_t sequence = 0;
  Timestamp log_time = 0;
  Timestamp publish_time = 0;
  Bytes data;

  bool operator==(const Sample& other) const {
    return topic == other.topic && sequence == other.sequence && log_time == other.log_time &&
           publish_time == other.publish_time && data == other.data;
  }
};

inline std::ostream& operator<<(std::ostream& out, const Sample& sample) {
  return out << sample.topic << " #" << sample.sequence << " at " << sample.log_time << " ("
             << sample.data.size() << " bytes)";
}

/// Messages on three topics, out of order by up to `jitter` ns, many at equal times.
inline std::vector<Sample> random_samples(unsigned seed, std::size_t count, Timestamp jitter) {
  std::mt19937 random(seed);
  std::vector<Sample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    Sample& sample = samples[i];
    sample.topic = std::string(1, static_cast<char>('a' + random() % 3));
    sample.sequence = static_cast<std::uint32_t>(i);
    sample.log_time = 1'000'000 + i / 2 * 1000 + random() % (jitter + 1);
    sample.publish_time = sample.log_time - random() % 1000;
    sample.data.resize(random() % 200);
    for (auto& byte : sample.data) byte = static_cast<std::uint8_t>(random() % 16);
  }
  return samples;
}

/// Writes the samples with channels a, b, c, one attachment and one metadata record.
inline void write_samples(const std::filesystem::path& path, const std::vector<Sample>& samples,
                          WriterParams params, bool close = true) {
  params.overwrite = true;
  auto writer = Writer::open(path, params);
  ASSERT_TRUE(writer.ok()) << writer.error().reason;
  const auto schema = writer->add_schema("test/msg/Blob", "ros2idl", std::string_view("idl"));
  ASSERT_TRUE(schema.ok());
  std::map<std::string, std::uint16_t> channels;
  for (const char* topic : {"a", "b", "c"}) {
    const auto channel = writer->add_channel(topic, "cdr", *schema, {{"key", topic}});
    ASSERT_TRUE(channel.ok());
    channels[topic] = *channel;
  }
  ASSERT_TRUE(writer->write(Metadata{"notes", {{"pilot", "nobody"}}}).ok());
  for (const Sample& sample : samples) {
    const Status done = writer->write(Message{channels[sample.topic], sample.sequence,
                                              sample.log_time, sample.publish_time, sample.data});
    ASSERT_TRUE(done.ok()) << done.error().reason;
  }
  ASSERT_TRUE(writer
                  ->write(Attachment{7, 8, "map.pgm", "image/x-portable-graymap",
                                     Bytes(1000, std::uint8_t{42})})
                  .ok());
  if (close) {
    const Status done = writer->close();
    ASSERT_TRUE(done.ok()) << done.error().reason;
  }
}

/// All that a cursor gives; errors become test failures.
inline std::vector<Sample> read_samples(const Reader& reader, Filter filter = {}) {
  std::vector<Sample> samples;
  MessageCursor cursor = reader.messages(std::move(filter));
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) {
      ADD_FAILURE() << next.error().reason;
      return samples;
    }
    if (!next->has_value()) return samples;
    const MessageView& view = **next;
    samples.push_back({view.channel->topic, view.message.sequence, view.message.log_time,
                       view.message.publish_time, view.message.data.copy()});
  }
}

/// What reading must give: by log time, equal times in the order of writing.
inline std::vector<Sample> by_time(std::vector<Sample> samples) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.log_time < b.log_time; });
  return samples;
}

}  // namespace swiftlet::mcap
