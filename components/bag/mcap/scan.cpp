// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "components/bag/mcap/file_layout.hpp"

namespace swiftlet::mcap {
namespace {

class Scan {
 public:
  explicit Scan(Reader::State& state)
      : state_(state), stream_(*state.source, state.data_start, state.source->size()) {}

  void run() {
    for (;;) {
      const auto record = stream_.next();
      if (!record.ok()) return damaged(record.error());
      if (!record->has_value() || ends_data((*record)->opcode)) return;
      take(**record);
    }
  }

 private:
  static bool ends_data(Opcode opcode) {
    return opcode == Opcode::kDataEnd || opcode == Opcode::kFooter;
  }

  void damaged(const Error& error) { state_.damage.push_back(error); }

  void take(const RawRecord& record) {
    switch (record.opcode) {
      case Opcode::kSchema:
        return take_definition<Schema>(record, [this](Schema s) { add(std::move(s)); });
      case Opcode::kChannel:
        return take_definition<Channel>(record, [this](Channel c) { add(std::move(c)); });
      case Opcode::kMessage:
        return take_message(record);
      case Opcode::kChunk:
        return take_chunk(record);
      case Opcode::kAttachment:
        return take_attachment(record);
      case Opcode::kMetadata:
        return take_definition<Metadata>(record, [&](Metadata m) {
          state_.metadata.push_back({record.offset, record.end() - record.offset, m.name});
          ++state_.statistics.metadata_count;
        });
      default:
        return;  // indexes, which are not needed, and records of later versions
    }
  }

  template <class Record, class Use>
  void take_definition(const RawRecord& record, Use&& use) {
    Record value;
    const Status done = stream_.decode_into(record, value, content_);
    if (!done.ok()) return damaged(done.error());
    use(std::move(value));
  }

  void add(Schema schema) {
    if (schema.id == 0) return;  // invalid; the specification has readers ignore it
    const auto [known, is_new] = state_.schemas.emplace(schema.id, schema);
    if (!is_new && !(known->second == schema)) conflict("schema", schema.id);
    state_.statistics.schema_count = static_cast<std::uint16_t>(state_.schemas.size());
  }

  void add(Channel channel) {
    const auto [known, is_new] = state_.channels.emplace(channel.id, channel);
    if (!is_new && !(known->second == channel)) conflict("channel", channel.id);
    state_.statistics.channel_count = static_cast<std::uint32_t>(state_.channels.size());
  }

  void conflict(const char* kind, std::uint16_t id) {
    damaged(Error{state_.source->name() + ": " + kind + " " + std::to_string(id) +
                  " is described twice, and differently; the first description is used"});
  }

  void count(const Message& message) {
    Statistics& total = state_.statistics;
    const bool first = total.message_count == 0;
    total.message_start_time =
        first ? message.log_time : std::min(total.message_start_time, message.log_time);
    total.message_end_time = std::max(total.message_end_time, message.log_time);
    ++total.message_count;
    ++total.channel_message_counts[message.channel_id];
  }

  void take_message(const RawRecord& record) {
    constexpr std::uint64_t kFixedFields = 22;  // everything but the data
    RawRecord front = record;
    front.length = std::min(record.length, kFixedFields);
    Message message;
    if (!stream_.decode_into(front, message, content_).ok()) {
      return damaged(stream_.malformed(record));
    }
    if (state_.channels.count(message.channel_id) == 0) {
      return damaged(error_at(*state_.source, record.offset, unknown_channel(message.channel_id)));
    }
    state_.loose_messages.push_back({message.log_time, record});
    count(message);
  }

  static std::string unknown_channel(std::uint16_t id) {
    return "a message belongs to channel " + std::to_string(id) +
           ", which nothing before it describes; it is left out";
  }

  void take_chunk(const RawRecord& record) {
    Chunk chunk;
    ChunkIndex index;
    index.chunk_start_offset = record.offset;
    index.chunk_length = record.end() - record.offset;
    const Status done =
        read_chunk(*state_.source, record, state_.params.max_chunk_size, content_, chunk, raw_);
    index.message_start_time = last_time_;
    index.message_end_time = last_time_;
    if (done.ok()) {
      fill(record, index);
    } else {
      damaged(done.error());
    }
    index.compression = chunk.compression;
    index.uncompressed_size = chunk.uncompressed_size;
    last_time_ = index.message_end_time;
    state_.chunks.push_back(std::move(index));
    ++state_.statistics.chunk_count;
  }

  /// Takes times and channels from the messages themselves.
  void fill(const RawRecord& record, ChunkIndex& index) {
    bool first = true;
    const std::string problem = walk_chunk(
        raw_, [this](Schema& schema) { add(std::move(schema)); },
        [this](Channel& channel) { add(std::move(channel)); },
        [&](const Message& message, const RawRecord&) {
          index.message_start_time =
              first ? message.log_time : std::min(index.message_start_time, message.log_time);
          index.message_end_time =
              first ? message.log_time : std::max(index.message_end_time, message.log_time);
          first = false;
          index.message_index_offsets[message.channel_id] = 0;
          if (state_.channels.count(message.channel_id) != 0) count(message);
        });
    if (!problem.empty()) damaged(error_at(*state_.source, record.offset, "chunk " + problem));
  }

  void take_attachment(const RawRecord& record) {
    Attachment attachment;
    bool crc_matches = false;
    const Status done = stream_.read(record, content_);
    if (!done.ok()) return damaged(done.error());
    if (!decode(content_, attachment, crc_matches)) return damaged(stream_.malformed(record));
    state_.attachments.push_back({record.offset, record.end() - record.offset, attachment.log_time,
                                  attachment.create_time, attachment.data.size(), attachment.name,
                                  attachment.media_type});
    ++state_.statistics.attachment_count;
  }

  Reader::State& state_;
  RecordStream stream_;
  Timestamp last_time_ = 0;
  Bytes content_;
  Bytes raw_;
};

}  // namespace

void load_by_scan(Reader::State& state) {
  Scan(state).run();
}

}  // namespace swiftlet::mcap
