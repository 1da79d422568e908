// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/record_codec.hpp"

namespace swiftlet::mcap {
namespace {

template <class T>
void put(Bytes& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
}

void put(Bytes& out, ByteView bytes) {
  if (bytes.size > 0) out.insert(out.end(), bytes.data, bytes.data + bytes.size);
}

void put(Bytes& out, const std::string& text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  put(out, ByteView(std::string_view(text)));
}

template <class T>
void overwrite(Bytes& out, std::size_t at, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out[at + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
}

/// Fills in the u32 byte length of an array or a map once its elements are written.
template <class Elements>
void put_sized(Bytes& out, Elements&& elements) {
  const std::size_t at = out.size();
  put(out, std::uint32_t{0});
  elements();
  overwrite(out, at, static_cast<std::uint32_t>(out.size() - at - 4));
}

void put(Bytes& out, const std::map<std::string, std::string>& map) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put(out, key);
      put(out, value);
    }
  });
}

void put(Bytes& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put(out, key);
      put(out, value);
    }
  });
}

template <class Content>
void put_record(Bytes& out, Opcode opcode, Content&& content) {
  out.push_back(static_cast<std::uint8_t>(opcode));
  const std::size_t at = out.size();
  put(out, std::uint64_t{0});
  content();
  overwrite(out, at, static_cast<std::uint64_t>(out.size() - at - 8));
}

}  // namespace

void append(Bytes& out, const Header& record) {
  put_record(out, Opcode::kHeader, [&] {
    put(out, record.profile);
    put(out, record.library);
  });
}

void append(Bytes& out, const Footer& record) {
  put_record(out, Opcode::kFooter, [&] {
    put(out, record.summary_start);
    put(out, record.summary_offset_start);
    put(out, record.summary_crc);
  });
}

void append(Bytes& out, const Schema& record) {
  put_record(out, Opcode::kSchema, [&] {
    put(out, record.id);
    put(out, record.name);
    put(out, record.encoding);
    put(out, static_cast<std::uint32_t>(record.data.size()));
    put(out, ByteView(record.data));
  });
}

void append(Bytes& out, const Channel& record) {
  put_record(out, Opcode::kChannel, [&] {
    put(out, record.id);
    put(out, record.schema_id);
    put(out, record.topic);
    put(out, record.message_encoding);
    put(out, record.metadata);
  });
}

void append(Bytes& out, const Message& record) {
  put_record(out, Opcode::kMessage, [&] {
    put(out, record.channel_id);
    put(out, record.sequence);
    put(out, record.log_time);
    put(out, record.publish_time);
    put(out, record.data);
  });
}

void append(Bytes& out, const Chunk& record) {
  put_record(out, Opcode::kChunk, [&] {
    put(out, record.message_start_time);
    put(out, record.message_end_time);
    put(out, record.uncompressed_size);
    put(out, record.uncompressed_crc);
    put(out, record.compression);
    put(out, static_cast<std::uint64_t>(record.records.size));
    put(out, record.records);
  });
}

void append(Bytes& out, const MessageIndex& record) {
  put_record(out, Opcode::kMessageIndex, [&] {
    put(out, record.channel_id);
    put_sized(out, [&] {
      for (const auto& [log_time, offset] : record.records) {
        put(out, log_time);
        put(out, offset);
      }
    });
  });
}

void append(Bytes& out, const ChunkIndex& record) {
  put_record(out, Opcode::kChunkIndex, [&] {
    put(out, record.message_start_time);
    put(out, record.message_end_time);
    put(out, record.chunk_start_offset);
    put(out, record.chunk_length);
    put(out, record.message_index_offsets);
    put(out, record.message_index_length);
    put(out, record.compression);
    put(out, record.compressed_size);
    put(out, record.uncompressed_size);
  });
}

void append(Bytes& out, const Attachment& record) {
  put_record(out, Opcode::kAttachment, [&] {
    const std::size_t start = out.size();
    put(out, record.log_time);
    put(out, record.create_time);
    put(out, record.name);
    put(out, record.media_type);
    put(out, static_cast<std::uint64_t>(record.data.size()));
    put(out, ByteView(record.data));
    put(out, crc32(ByteView(out.data() + start, out.size() - start)));
  });
}

void append(Bytes& out, const AttachmentIndex& record) {
  put_record(out, Opcode::kAttachmentIndex, [&] {
    put(out, record.offset);
    put(out, record.length);
    put(out, record.log_time);
    put(out, record.create_time);
    put(out, record.data_size);
    put(out, record.name);
    put(out, record.media_type);
  });
}

void append(Bytes& out, const Statistics& record) {
  put_record(out, Opcode::kStatistics, [&] {
    put(out, record.message_count);
    put(out, record.schema_count);
    put(out, record.channel_count);
    put(out, record.attachment_count);
    put(out, record.metadata_count);
    put(out, record.chunk_count);
    put(out, record.message_start_time);
    put(out, record.message_end_time);
    put(out, record.channel_message_counts);
  });
}

void append(Bytes& out, const Metadata& record) {
  put_record(out, Opcode::kMetadata, [&] {
    put(out, record.name);
    put(out, record.metadata);
  });
}

void append(Bytes& out, const MetadataIndex& record) {
  put_record(out, Opcode::kMetadataIndex, [&] {
    put(out, record.offset);
    put(out, record.length);
    put(out, record.name);
  });
}

void append(Bytes& out, const SummaryOffset& record) {
  put_record(out, Opcode::kSummaryOffset, [&] {
    put(out, static_cast<std::uint8_t>(record.group_opcode));
    put(out, record.group_start);
    put(out, record.group_length);
  });
}

void append(Bytes& out, const DataEnd& record) {
  put_record(out, Opcode::kDataEnd, [&] { put(out, record.data_section_crc); });
}

}  // namespace swiftlet::mcap
