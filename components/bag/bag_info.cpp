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
#include <tuple>
#include <utility>

#include "components/bag/recording_records.hpp"

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
  Loss loss;
};

/// Bytes of the messages of each channel that can be read.
std::map<std::uint16_t, std::uint64_t> sizes_of(const Recording& recording) {
  std::map<std::uint16_t, std::uint64_t> sizes;
  auto cursor = recording.messages();
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) continue;  // `verify` says what is damaged
    if (!*next) return sizes;
    sizes[(*next)->channel->id] += (*next)->message.data.size;
  }
}

/// Channels of one topic that several components wrote are one to a reader.
std::vector<TopicInfo> united(const std::vector<TopicInfo>& channels) {
  std::vector<TopicInfo> topics;
  for (const TopicInfo& channel : channels) {
    const bool is_more = !topics.empty() && topics.back().topic == channel.topic &&
                         topics.back().type == channel.type &&
                         topics.back().message_encoding == channel.message_encoding;
    if (!is_more) {
      topics.push_back(channel);
      continue;
    }
    topics.back().messages += channel.messages;
    topics.back().bytes += channel.bytes;
    topics.back().loss.by_dds += channel.loss.by_dds;
    topics.back().loss.by_recorder += channel.loss.by_recorder;
  }
  return topics;
}

/// One entry a topic, by name.
std::vector<TopicInfo> topics_of(const Recording& recording, bool with_sizes) {
  std::vector<TopicInfo> topics;
  auto sizes = with_sizes ? sizes_of(recording) : std::map<std::uint16_t, std::uint64_t>();
  const auto& counts = recording.statistics().channel_message_counts;
  auto losses = losses_of(recording).value_or(LossLedger());
  for (const auto& [id, channel] : recording.channels()) {
    TopicInfo info;
    info.topic = channel.topic;
    info.message_encoding = channel.message_encoding;
    const auto schema = recording.schemas().find(channel.schema_id);
    if (schema != recording.schemas().end()) {
      info.type = schema->second.name;
      info.schema_encoding = schema->second.encoding;
    }
    const auto count = counts.find(id);
    info.messages = count != counts.end() ? count->second : 0;
    info.bytes = sizes[id];
    // Of several channels of one topic, the first speaks for it.
    info.loss = std::exchange(losses[channel.topic], Loss{});
    topics.push_back(std::move(info));
  }
  std::stable_sort(topics.begin(), topics.end(), [](const TopicInfo& a, const TopicInfo& b) {
    return std::tie(a.topic, a.type, a.message_encoding) <
           std::tie(b.topic, b.type, b.message_encoding);
  });
  return united(topics);
}

double duration_s(const mcap::Statistics& statistics) {
  if (statistics.message_end_time <= statistics.message_start_time) return 0.0;
  return 1e-9 * static_cast<double>(statistics.message_end_time - statistics.message_start_time);
}

/// Messages per second between the first and the last of the file.
double rate_hz(std::uint64_t messages, double duration) {
  return messages > 1 && duration > 0.0 ? static_cast<double>(messages - 1) / duration : 0.0;
}

struct ChunkSums {
  std::size_t count = 0;
  std::uint64_t stored = 0;
  std::uint64_t uncompressed = 0;
  std::string compressions;
};

ChunkSums sums_of(const Recording& recording) {
  ChunkSums sums;
  std::map<std::string, int> kinds;
  for (const mcap::Reader& file : recording.files()) {
    for (const mcap::ChunkIndex& chunk : file.chunks()) {
      sums.stored += chunk.chunk_length;
      sums.uncompressed += chunk.uncompressed_size;
      ++sums.count;
      ++kinds[chunk.compression.empty() ? "none" : chunk.compression];
    }
  }
  for (const auto& [kind, count] : kinds) {
    sums.compressions += (sums.compressions.empty() ? "" : ", ") + kind;
  }
  return sums;
}

std::uint64_t size_of(const Recording& recording) {
  std::uint64_t bytes = 0;
  for (const mcap::Reader& file : recording.files()) bytes += file.size();
  return bytes;
}

bool is_indexed(const Recording& recording) {
  return std::all_of(recording.files().begin(), recording.files().end(),
                     [](const mcap::Reader& file) { return file.indexed(); });
}

/// Names of metadata records that are shown in no other line.
std::vector<std::string> foreign_metadata(const Recording& recording) {
  std::vector<std::string> names;
  for (const mcap::Reader& file : recording.files()) {
    for (const auto& metadata : file.metadata()) {
      const bool is_shown = metadata.name == kRunRecord || metadata.name == kLossRecord ||
                            metadata.name == kPartRecord;
      if (!is_shown) names.push_back(metadata.name);
    }
  }
  return names;
}

}  // namespace

std::string printable(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  }
  return text;
}

std::string moment_text(mcap::Timestamp time) {
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

std::string describe(const Recording& recording, bool sizes) {
  const mcap::Statistics& statistics = recording.statistics();
  const double duration = duration_s(statistics);
  std::string out;
  const auto line = [&](const char* name, const std::string& value) {
    out += fmt::format("{:<13}{}\n", name, printable(value));
  };
  line("file", recording.name());
  const auto& files = recording.files();
  if (files.size() > 1) {
    line("files", std::to_string(files.size()));
    for (const mcap::Reader& file : files) line("", file.name());
  }
  line("size", size_text(size_of(recording)));
  line("profile",
       files.front().header().profile + ", written by " + files.front().header().library);
  line("messages", std::to_string(statistics.message_count));
  if (statistics.message_count > 0) {
    line("from", moment_text(statistics.message_start_time));
    line("to", moment_text(statistics.message_end_time));
    line("duration", fmt::format("{:.3f} s", duration));
  }
  const auto losses = losses_of(recording);
  const Loss lost = total(losses.value_or(LossLedger()));
  if (losses) {
    line("losses", lost.total() == 0 ? "none"
                                     : fmt::format("{} messages: DDS lost {}, the recorder {}",
                                                   lost.total(), lost.by_dds, lost.by_recorder));
  }
  const ChunkSums sums = sums_of(recording);
  line("chunks", sums.count == 0
                     ? "none"
                     : fmt::format("{}, compression {}, {} of {}", sums.count, sums.compressions,
                                   size_text(sums.stored), size_text(sums.uncompressed)));
  line("index", is_indexed(recording) ? "yes" : "no: the file was read from the front");
  if (const auto run = metadata_named(recording, kRunRecord)) {
    std::string text;
    for (const auto& [key, value] : run->metadata) {
      if (!value.empty()) text += (text.empty() ? "" : ", ") + key + " " + value;
    }
    line("run", text);
  }
  for (const mcap::Reader& file : files) {
    for (const auto& attachment : file.attachments()) {
      line("attachment", attachment.name + " (" + attachment.media_type + ", " +
                             size_text(attachment.data_size) + ")");
    }
  }
  for (const std::string& name : foreign_metadata(recording)) line("metadata", name);

  const auto topics = topics_of(recording, sizes);
  std::size_t topic_width = 5;
  std::size_t type_width = 4;
  for (const TopicInfo& info : topics) {
    topic_width = std::max(topic_width, info.topic.size());
    type_width = std::max(type_width, info.type.size());
  }
  const auto row = [&](const std::string& topic, const std::string& type,
                       const std::string& encoding, const std::string& messages,
                       const std::string& rate, const std::string& missing,
                       const std::string& size) {
    out += fmt::format("{:<{}}  {:<{}}  {:<8}  {:>9}  {:>9}", topic, topic_width, type, type_width,
                       encoding, messages, rate);
    if (lost.total() > 0) out += fmt::format("  {:>9}", missing);
    out += sizes ? fmt::format("  {:>11}\n", size) : "\n";
  };
  out += "\n";
  row("topic", "type", "encoding", "messages", "rate [Hz]", "lost", "size");
  for (const TopicInfo& info : topics) {
    // One message, or several at one moment, have no rate.
    const double rate = rate_hz(info.messages, duration);
    row(printable(info.topic), printable(info.type), printable(info.message_encoding),
        std::to_string(info.messages), rate > 0.0 ? fmt::format("{:.2f}", rate) : "-",
        std::to_string(info.loss.total()), size_text(info.bytes));
  }
  return out;
}

json to_json(const Recording& recording, bool sizes) {
  const mcap::Statistics& statistics = recording.statistics();
  const double duration = duration_s(statistics);
  json out = {{"file", recording.name()},
              {"files", json::array()},
              {"size_bytes", size_of(recording)},
              {"profile", recording.files().front().header().profile},
              {"library", recording.files().front().header().library},
              {"finished", recording.finished()},
              {"indexed", is_indexed(recording)},
              {"messages", statistics.message_count},
              {"start_ns", statistics.message_start_time},
              {"end_ns", statistics.message_end_time},
              {"duration_s", duration},
              {"chunks", sums_of(recording).count},
              {"losses", nullptr},
              {"topics", json::array()},
              {"attachments", json::array()},
              {"metadata", json::array()},
              {"damage", json::array()}};
  const auto losses = losses_of(recording);
  if (losses) {
    const Loss sum = total(*losses);
    out["losses"] = {{"dds", sum.by_dds}, {"recorder", sum.by_recorder}};
  }
  for (const TopicInfo& info : topics_of(recording, sizes)) {
    json topic = {{"topic", info.topic},
                  {"type", info.type},
                  {"schema_encoding", info.schema_encoding},
                  {"message_encoding", info.message_encoding},
                  {"messages", info.messages},
                  {"rate_hz", rate_hz(info.messages, duration)}};
    if (losses) topic["lost"] = {{"dds", info.loss.by_dds}, {"recorder", info.loss.by_recorder}};
    if (sizes) topic["size_bytes"] = info.bytes;
    out["topics"].push_back(std::move(topic));
  }
  for (const mcap::Reader& file : recording.files()) {
    out["files"].push_back({{"file", file.name()},
                            {"size_bytes", file.size()},
                            {"finished", file.finished()},
                            {"messages", file.statistics().message_count}});
    for (const auto& attachment : file.attachments()) {
      out["attachments"].push_back({{"name", attachment.name},
                                    {"media_type", attachment.media_type},
                                    {"size_bytes", attachment.data_size}});
    }
    for (const auto& index : file.metadata()) {
      const auto metadata = file.read(index);
      out["metadata"].push_back(
          {{"name", index.name}, {"values", metadata.ok() ? json(metadata->metadata) : json()}});
    }
  }
  for (const Error& error : recording.damage()) out["damage"].push_back(error.reason);
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

json to_json(const RepairedFile& repaired) {
  return {{"file", repaired.file.string()},
          {"kept", repaired.kept ? json(repaired.kept->string()) : json()},
          {"saved_messages", repaired.repair.saved.message_count},
          {"lost_chunks", repaired.repair.lost_chunks},
          {"lost_messages", repaired.repair.lost_messages},
          {"skipped_bytes", repaired.repair.skipped_bytes},
          {"not_saved", repaired.repair.problems}};
}

}  // namespace swiftlet
