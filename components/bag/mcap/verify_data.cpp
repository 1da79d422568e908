// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "components/bag/mcap/file_layout.hpp"
#include "components/bag/mcap/verify_parts.hpp"

namespace swiftlet::mcap {
namespace {

class DataVerifier {
 public:
  DataVerifier(const ReaderParams& params, Findings& findings, Contents& contents)
      : params_(params),
        findings_(findings),
        contents_(contents),
        counted_(findings.result().counted) {}

  bool run(RecordStream& stream) {
    for (;;) {
      const auto record = stream.next();
      if (!record.ok()) return findings_.problem(record.error().reason), false;
      if (!record->has_value()) {
        finish_chunk();
        findings_.problem_at(findings_.source().size(), "the data section has no end record");
        return false;
      }
      if ((*record)->opcode != Opcode::kMessageIndex) finish_chunk();
      if ((*record)->opcode == Opcode::kDataEnd) {
        check_data_end(stream, **record);
        return true;
      }
      check_data_record(stream, **record);
    }
  }

 private:
  void check_data_record(const RecordStream& stream, const RawRecord& raw) {
    switch (raw.opcode) {
      case Opcode::kSchema:
        if (auto schema = findings_.decoded<Schema>(stream, raw)) define(raw.offset, *schema);
        return;
      case Opcode::kChannel:
        if (auto channel = findings_.decoded<Channel>(stream, raw)) define(raw.offset, *channel);
        return;
      case Opcode::kMessage:
        if (const auto message = findings_.decoded<Message>(stream, raw))
          count(raw.offset, *message);
        return;
      case Opcode::kChunk:
        return check_chunk(raw);
      case Opcode::kMessageIndex:
        if (const auto index = findings_.decoded<MessageIndex>(stream, raw)) check(raw, *index);
        return;
      case Opcode::kAttachment:
        return check_attachment(stream, raw);
      case Opcode::kMetadata:
        if (const auto metadata = findings_.decoded<Metadata>(stream, raw)) {
          contents_.metadata[raw.offset] = {raw.offset, raw.end() - raw.offset, metadata->name};
          ++counted_.metadata_count;
        }
        return;
      default:
        findings_.foreign_record(raw, "data section");
    }
  }

  void define(std::uint64_t offset, const Schema& schema) {
    if (schema.id == 0) return findings_.problem_at(offset, "a schema must not have the id 0");
    const auto [known, is_new] = contents_.schemas.emplace(schema.id, schema);
    if (!is_new && !(known->second == schema)) {
      findings_.problem_at(
          offset, "schema " + std::to_string(schema.id) + " is described differently before");
    }
    counted_.schema_count = static_cast<std::uint16_t>(contents_.schemas.size());
  }

  void define(std::uint64_t offset, const Channel& channel) {
    const auto [known, is_new] = contents_.channels.emplace(channel.id, channel);
    if (!is_new && !(known->second == channel)) {
      findings_.problem_at(
          offset, "channel " + std::to_string(channel.id) + " is described differently before");
    }
    if (channel.schema_id != 0 && contents_.schemas.count(channel.schema_id) == 0) {
      findings_.problem_at(offset, "channel " + std::to_string(channel.id) + " (\"" +
                                       channel.topic + "\") names schema " +
                                       std::to_string(channel.schema_id) +
                                       ", which nothing before it describes");
    }
    counted_.channel_count = static_cast<std::uint32_t>(contents_.channels.size());
  }

  void count(std::uint64_t offset, const Message& message) {
    if (contents_.channels.count(message.channel_id) == 0) {
      findings_.problem_at(offset, "a message belongs to channel " +
                                       std::to_string(message.channel_id) +
                                       ", which nothing before it describes");
    }
    Statistics& total = counted_;
    const bool first = total.message_count == 0;
    total.message_start_time =
        first ? message.log_time : std::min(total.message_start_time, message.log_time);
    total.message_end_time = std::max(total.message_end_time, message.log_time);
    ++total.message_count;
    ++total.channel_message_counts[message.channel_id];
  }

  void check_chunk(const RawRecord& raw) {
    Chunk chunk;
    ++counted_.chunk_count;
    const Status done =
        read_chunk(findings_.source(), raw, params_.max_chunk_size, content_, chunk, records_);
    if (!done.ok()) {
      contents_.lost_messages = true;
      return findings_.problem(done.error().reason);
    }
    ChunkIndex index;
    index.chunk_start_offset = raw.offset;
    index.chunk_length = raw.end() - raw.offset;
    index.compression = chunk.compression;
    index.compressed_size = compressed_size(raw, chunk);
    index.uncompressed_size = chunk.uncompressed_size;
    bool first = true;
    const std::string wrong = walk_chunk(
        records_, [&](const Schema& schema) { define(raw.offset, schema); },
        [&](const Channel& channel) { define(raw.offset, channel); },
        [&](const Message& message, const RawRecord& place) {
          const Timestamp time = message.log_time;
          index.message_start_time = first ? time : std::min(index.message_start_time, time);
          index.message_end_time = std::max(index.message_end_time, time);
          first = false;
          count(raw.offset, message);
          chunk_messages_[message.channel_id].emplace_back(time, place.offset);
        });
    if (!wrong.empty()) findings_.problem_at(raw.offset, "chunk " + wrong);
    if (chunk.message_start_time != index.message_start_time ||
        chunk.message_end_time != index.message_end_time) {
      findings_.problem_at(raw.offset, "chunk gives other times than its messages have");
    }
    chunk_offset_ = raw.offset;
    contents_.chunks[raw.offset] = std::move(index);
  }

  /// Of the records, which are the last known field: whatever is in front of them is fixed.
  static std::uint64_t compressed_size(const RawRecord& raw, const Chunk& chunk) {
    const std::uint64_t in_front = 8 + 8 + 8 + 4 + 4 + chunk.compression.size() + 8;
    return raw.length - std::min(raw.length, in_front);
  }

  void check(const RawRecord& raw, const MessageIndex& index) {
    if (!chunk_offset_) {
      if (contents_.lost_messages) return;  // the damaged chunk before it was named already
      return findings_.problem_at(raw.offset, "a message index follows no chunk");
    }
    auto sorted = index.records;
    auto& actual = chunk_messages_[index.channel_id];
    std::sort(sorted.begin(), sorted.end());
    std::sort(actual.begin(), actual.end());
    if (sorted != actual) {
      findings_.problem_at(raw.offset, "the message index of channel " +
                                           std::to_string(index.channel_id) +
                                           " does not name the messages of the chunk before it");
    }
    ChunkIndex& chunk = contents_.chunks[*chunk_offset_];
    chunk.message_index_offsets[index.channel_id] = raw.offset;
    chunk.message_index_length += raw.end() - raw.offset;
  }

  /// Message indexes are all or nothing.
  void finish_chunk() {
    if (chunk_offset_) {
      const ChunkIndex& chunk = contents_.chunks[*chunk_offset_];
      for (const auto& [channel, messages] : chunk_messages_) {
        if (!chunk.message_index_offsets.empty() && !messages.empty() &&
            chunk.message_index_offsets.count(channel) == 0) {
          findings_.problem_at(*chunk_offset_, "the chunk has messages of channel " +
                                                   std::to_string(channel) +
                                                   " and no index of them");
        }
      }
    }
    chunk_offset_.reset();
    chunk_messages_.clear();
  }

  void check_attachment(const RecordStream& stream, const RawRecord& raw) {
    Attachment attachment;
    bool crc_matches = false;
    if (const Status done = stream.read(raw, content_); !done.ok()) {
      return findings_.problem(done.error().reason);
    }
    if (!decode(content_, attachment, crc_matches))
      return findings_.problem(stream.malformed(raw).reason);
    if (!crc_matches) {
      findings_.problem_at(
          raw.offset, "attachment \"" + attachment.name + "\" is damaged: its checksum is wrong");
    }
    contents_.attachments[raw.offset] = {raw.offset,
                                         raw.end() - raw.offset,
                                         attachment.log_time,
                                         attachment.create_time,
                                         attachment.data.size(),
                                         attachment.name,
                                         attachment.media_type};
    ++counted_.attachment_count;
  }

  void check_data_end(const RecordStream& stream, const RawRecord& raw) {
    contents_.end = raw.end();
    const auto end = findings_.decoded<DataEnd>(stream, raw);
    if (!end || end->data_section_crc == 0) return;
    const auto crc = findings_.crc_of(0, raw.offset);
    if (crc && *crc != end->data_section_crc) {
      findings_.problem_at(
          raw.offset,
          "the checksum of the data section is wrong: something before this place was "
          "changed");
    }
  }

  const ReaderParams& params_;
  Findings& findings_;
  Contents& contents_;
  Statistics& counted_;
  Bytes content_;
  Bytes records_;
  // The chunk that message indexes may still follow.
  std::optional<std::uint64_t> chunk_offset_;
  std::map<std::uint16_t, std::vector<std::pair<Timestamp, std::uint64_t>>> chunk_messages_;
};

}  // namespace

bool verify_data(RecordStream& stream, const ReaderParams& params, Findings& findings,
                 Contents& contents) {
  return DataVerifier(params, findings, contents).run(stream);
}

}  // namespace swiftlet::mcap
