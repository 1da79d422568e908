// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/record_codec.hpp"

namespace swiftlet::mcap {
namespace {

/// Reads fields one after another and remembers if one of them did not fit.
class Fields {
 public:
  explicit Fields(ByteView content) : content_(content) {}

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  bool at_end() const { return !ok_ || position_ == content_.size; }

  template <class T>
  void get(T& value) {
    const ByteView bytes = take(sizeof(T));
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < bytes.size; ++i) sum |= std::uint64_t{bytes.data[i]} << (8 * i);
    value = static_cast<T>(sum);
  }

  void get(std::string& text) {
    const ByteView bytes = take_sized<std::uint32_t>();
    text.assign(reinterpret_cast<const char*>(bytes.data), bytes.size);
  }

  template <class Key, class Value>
  void get(std::map<Key, Value>& map) {
    map.clear();
    Fields entries(take_sized<std::uint32_t>());
    while (!entries.at_end()) {
      Key key{};
      Value value{};
      entries.get(key);
      entries.get(value);
      if (entries.ok()) map[std::move(key)] = std::move(value);
    }
    ok_ = ok_ && entries.ok();
  }

  template <class Length>
  ByteView take_sized() {
    Length length = 0;
    get(length);
    return take(length);
  }

  ByteView rest() { return take(content_.size - position_); }

 private:
  ByteView take(std::uint64_t count) {
    if (!ok_ || count > content_.size - position_) {
      ok_ = false;
      return {};
    }
    const ByteView bytes = content_.part(position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return bytes;
  }

  ByteView content_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

template <class... T>
bool decode_fields(ByteView content, T&... fields) {
  Fields in(content);
  (in.get(fields), ...);
  return in.ok();
}

}  // namespace

bool decode(ByteView content, Header& record) {
  return decode_fields(content, record.profile, record.library);
}

bool decode(ByteView content, Footer& record) {
  return decode_fields(content, record.summary_start, record.summary_offset_start,
                       record.summary_crc);
}

bool decode(ByteView content, Schema& record) {
  Fields in(content);
  in.get(record.id);
  in.get(record.name);
  in.get(record.encoding);
  record.data = in.take_sized<std::uint32_t>().copy();
  return in.ok();
}

bool decode(ByteView content, Channel& record) {
  return decode_fields(content, record.id, record.schema_id, record.topic, record.message_encoding,
                       record.metadata);
}

bool decode(ByteView content, Message& record) {
  Fields in(content);
  in.get(record.channel_id);
  in.get(record.sequence);
  in.get(record.log_time);
  in.get(record.publish_time);
  record.data = in.rest();
  return in.ok();
}

bool decode(ByteView content, Chunk& record) {
  Fields in(content);
  in.get(record.message_start_time);
  in.get(record.message_end_time);
  in.get(record.uncompressed_size);
  in.get(record.uncompressed_crc);
  in.get(record.compression);
  record.records = in.take_sized<std::uint64_t>();
  return in.ok();
}

bool decode(ByteView content, MessageIndex& record) {
  Fields in(content);
  in.get(record.channel_id);
  Fields entries(in.take_sized<std::uint32_t>());
  record.records.clear();
  while (!entries.at_end()) {
    std::pair<Timestamp, std::uint64_t> entry;
    entries.get(entry.first);
    entries.get(entry.second);
    if (entries.ok()) record.records.push_back(entry);
  }
  return in.ok() && entries.ok();
}

bool decode(ByteView content, ChunkIndex& record) {
  return decode_fields(content, record.message_start_time, record.message_end_time,
                       record.chunk_start_offset, record.chunk_length, record.message_index_offsets,
                       record.message_index_length, record.compression, record.compressed_size,
                       record.uncompressed_size);
}

bool decode(ByteView content, Attachment& record, bool& crc_matches) {
  Fields in(content);
  in.get(record.log_time);
  in.get(record.create_time);
  in.get(record.name);
  in.get(record.media_type);
  record.data = in.take_sized<std::uint64_t>().copy();
  const std::size_t checked = in.position();
  std::uint32_t crc = 0;
  in.get(crc);
  crc_matches = crc == 0 || (in.ok() && crc == crc32(content.part(0, checked)));
  return in.ok();
}

bool decode(ByteView content, AttachmentIndex& record) {
  return decode_fields(content, record.offset, record.length, record.log_time, record.create_time,
                       record.data_size, record.name, record.media_type);
}

bool decode(ByteView content, Statistics& record) {
  return decode_fields(content, record.message_count, record.schema_count, record.channel_count,
                       record.attachment_count, record.metadata_count, record.chunk_count,
                       record.message_start_time, record.message_end_time,
                       record.channel_message_counts);
}

bool decode(ByteView content, Metadata& record) {
  return decode_fields(content, record.name, record.metadata);
}

bool decode(ByteView content, MetadataIndex& record) {
  return decode_fields(content, record.offset, record.length, record.name);
}

bool decode(ByteView content, SummaryOffset& record) {
  return decode_fields(content, record.group_opcode, record.group_start, record.group_length);
}

bool decode(ByteView content, DataEnd& record) {
  return decode_fields(content, record.data_section_crc);
}

RecordPrefix decode_prefix(ByteView bytes) {
  RecordPrefix prefix;
  Fields in(bytes);
  in.get(prefix.opcode);
  in.get(prefix.length);
  return prefix;
}

}  // namespace swiftlet::mcap
