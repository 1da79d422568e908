// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/bag_info.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace swiftlet {
namespace {

using nlohmann::json;

struct TopicInfo {
  std::string topic;
  std::string type;
  std::string schema_encoding;
  std::string message_encoding;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;  // where sizes were asked for
};

/// Bytes of the messages of each channel that can be read.
std::map<std::uint16_t, std::uint64_t> sizes_of(const mcap::Reader& reader) {
  std::map<std::uint16_t, std::uint64_t> sizes;
  auto cursor = reader.messages();
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) continue;  // `verify` says what is damaged
    if (!*next) return sizes;
    sizes[(*next)->channel->id] += (*next)->message.data.size;
  }
}

/// One entry a channel, by topic name.
std::vector<TopicInfo> topics_of(const mcap::Reader& reader, bool with_sizes) {
  std::vector<TopicInfo> topics;
  auto sizes = with_sizes ? sizes_of(reader) : std::map<std::uint16_t, std::uint64_t>();
  const auto& counts = reader.statistics().channel_message_counts;
  for (const auto& [id, channel] : reader.channels()) {
    TopicInfo info;
    info.topic = channel.topic;
    info.message_encoding = channel.message_encoding;
    const auto schema = reader.schemas().find(channel.schema_id);
    if (schema != reader.schemas().end()) {
      info.type = schema->second.name;
      info.schema_encoding = schema->second.encoding;
    }
    const auto count = counts.find(id);
    info.messages = count != counts.end() ? count->second : 0;
    info.bytes = sizes[id];
    topics.push_back(std::move(info));
  }
  std::stable_sort(topics.begin(), topics.end(),
                   [](const TopicInfo& a, const TopicInfo& b) { return a.topic < b.topic; });
  return topics;
}

double duration_s(const mcap::Statistics& statistics) {
  if (statistics.message_end_time <= statistics.message_start_time) return 0.0;
  return 1e-9 * static_cast<double>(statistics.message_end_time - statistics.message_start_time);
}

/// Messages per second between the first and the last of the file.
double rate_hz(std::uint64_t messages, double duration) {
  return messages > 1 && duration > 0.0 ? static_cast<double>(messages - 1) / duration : 0.0;
}

std::string moment(mcap::Timestamp time) {
  constexpr mcap::Timestamp kSecond = 1'000'000'000;
  const auto seconds = static_cast<std::time_t>(time / kSecond);
  std::string text = fmt::format("{}.{:09} s", time / kSecond, time % kSecond);
  constexpr std::time_t kYear2000 = 946'684'800;
  if (seconds > kYear2000) text += fmt::format(" ({:%F %T} UTC)", fmt::gmtime(seconds));
  return text;
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000) return fmt::format("{} bytes", bytes);
  if (bytes < 10'000'000) return fmt::format("{:.1f} kB", 1e-3 * static_cast<double>(bytes));
  return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

struct ChunkSums {
  std::uint64_t stored = 0;
  std::uint64_t uncompressed = 0;
  std::string compressions;
};

ChunkSums sums_of(const mcap::Reader& reader) {
  ChunkSums sums;
  std::map<std::string, int> kinds;
  for (const mcap::ChunkIndex& chunk : reader.chunks()) {
    sums.stored += chunk.chunk_length;
    sums.uncompressed += chunk.uncompressed_size;
    ++kinds[chunk.compression.empty() ? "none" : chunk.compression];
  }
  for (const auto& [kind, count] : kinds) {
    sums.compressions += (sums.compressions.empty() ? "" : ", ") + kind;
  }
  return sums;
}

}  // namespace

std::string printable(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  }
  return text;
}

std::string describe(const mcap::Reader& reader, bool sizes) {
  const mcap::Statistics& statistics = reader.statistics();
  const double duration = duration_s(statistics);
  std::string out;
  const auto line = [&](const char* name, const std::string& value) {
    out += fmt::format("{:<13}{}\n", name, printable(value));
  };
  line("file", reader.name());
  line("size", size_text(reader.size()));
  line("profile", reader.header().profile + ", written by " + reader.header().library);
  line("messages", std::to_string(statistics.message_count));
  if (statistics.message_count > 0) {
    line("from", moment(statistics.message_start_time));
    line("to", moment(statistics.message_end_time));
    line("duration", fmt::format("{:.3f} s", duration));
  }
  const ChunkSums sums = sums_of(reader);
  line("chunks",
       reader.chunks().empty()
           ? "none"
           : fmt::format("{}, compression {}, {} of {}", reader.chunks().size(), sums.compressions,
                         size_text(sums.stored), size_text(sums.uncompressed)));
  line("index", reader.indexed() ? "yes" : "no: the file was read from the front");
  for (const auto& attachment : reader.attachments()) {
    line("attachment", attachment.name + " (" + attachment.media_type + ", " +
                           size_text(attachment.data_size) + ")");
  }
  for (const auto& metadata : reader.metadata()) line("metadata", metadata.name);

  const auto topics = topics_of(reader, sizes);
  std::size_t topic_width = 5;
  std::size_t type_width = 4;
  for (const TopicInfo& info : topics) {
    topic_width = std::max(topic_width, info.topic.size());
    type_width = std::max(type_width, info.type.size());
  }
  const auto row = [&](const std::string& topic, const std::string& type,
                       const std::string& encoding, const std::string& messages,
                       const std::string& rate, const std::string& size) {
    out += fmt::format("{:<{}}  {:<{}}  {:<8}  {:>9}  {:>9}", topic, topic_width, type, type_width,
                       encoding, messages, rate);
    out += sizes ? fmt::format("  {:>11}\n", size) : "\n";
  };
  out += "\n";
  row("topic", "type", "encoding", "messages", "rate [Hz]", "size");
  for (const TopicInfo& info : topics) {
    // One message, or several at one moment, have no rate.
    const double rate = rate_hz(info.messages, duration);
    row(printable(info.topic), printable(info.type), printable(info.message_encoding),
        std::to_string(info.messages), rate > 0.0 ? fmt::format("{:.2f}", rate) : "-",
        size_text(info.bytes));
  }
  return out;
}

json to_json(const mcap::Reader& reader, bool sizes) {
  const mcap::Statistics& statistics = reader.statistics();
  const double duration = duration_s(statistics);
  json out = {{"file", reader.name()},
              {"size_bytes", reader.size()},
              {"profile", reader.header().profile},
              {"library", reader.header().library},
              {"finished", reader.finished()},
              {"indexed", reader.indexed()},
              {"messages", statistics.message_count},
              {"start_ns", statistics.message_start_time},
              {"end_ns", statistics.message_end_time},
              {"duration_s", duration},
              {"chunks", reader.chunks().size()},
              {"topics", json::array()},
              {"attachments", json::array()},
              {"metadata", json::array()},
              {"damage", json::array()}};
  for (const TopicInfo& info : topics_of(reader, sizes)) {
    json topic = {{"topic", info.topic},
                  {"type", info.type},
                  {"schema_encoding", info.schema_encoding},
                  {"message_encoding", info.message_encoding},
                  {"messages", info.messages},
                  {"rate_hz", rate_hz(info.messages, duration)}};
    if (sizes) topic["size_bytes"] = info.bytes;
    out["topics"].push_back(std::move(topic));
  }
  for (const auto& attachment : reader.attachments()) {
    out["attachments"].push_back({{"name", attachment.name},
                                  {"media_type", attachment.media_type},
                                  {"size_bytes", attachment.data_size}});
  }
  for (const auto& index : reader.metadata()) {
    const auto metadata = reader.read(index);
    out["metadata"].push_back(
        {{"name", index.name}, {"values", metadata.ok() ? json(metadata->metadata) : json()}});
  }
  for (const Error& error : reader.damage()) out["damage"].push_back(error.reason);
  return out;
}

json to_json(const std::string& file, const mcap::Verification& verification) {
  const mcap::Statistics& counted = verification.counted;
  return {{"file", file},
          {"sound", verification.problems.empty()},
          {"messages", counted.message_count},
          {"chunks", counted.chunk_count},
          {"channels", counted.channel_count},
          {"schemas", counted.schema_count},
          {"attachments", counted.attachment_count},
          {"metadata", counted.metadata_count},
          {"unknown_records", verification.unknown_records},
          {"problems", verification.problems},
          {"remarks", verification.remarks}};
}

}  // namespace swiftlet
