// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "components/bag/mcap/bytes.hpp"
#include "estimation/basics/time.hpp"

/// The records of an MCAP file, version 0, field for field as https://mcap.dev/spec has them.
namespace swiftlet::mcap {

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// "Chunk" for kChunk; "unknown" where the specification has no such record.
const char* name_of(Opcode opcode);

inline constexpr std::uint8_t kMagic[8] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
/// Opcode and length, in front of every record.
inline constexpr std::uint64_t kRecordPrefixSize = 9;

/// Nanoseconds since the epoch of the clock that drove the recording.
using Timestamp = std::uint64_t;

/// A moment before the epoch becomes the epoch: MCAP has no negative time.
constexpr Timestamp to_timestamp(Time time) {
  const auto ns = time.time_since_epoch().count();
  return ns < 0 ? 0 : static_cast<Timestamp>(ns);
}
/// A timestamp beyond the year 2262 becomes the last moment that Time can hold.
constexpr Time to_time(Timestamp ns) {
  constexpr auto last = std::numeric_limits<Duration::rep>::max();
  return Time(Duration(ns > static_cast<Timestamp>(last) ? last : static_cast<Duration::rep>(ns)));
}

struct Header {
  std::string profile;
  std::string library;
};

struct Footer {
  std::uint64_t summary_start = 0;
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;
};

struct Schema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;
  Bytes data;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: the messages have no schema
  std::string topic;
  std::string message_encoding;
  std::map<std::string, std::string> metadata;
};

bool operator==(const Schema& a, const Schema& b);
bool operator==(const Channel& a, const Channel& b);

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  Timestamp log_time = 0;      ///< [ns]
  Timestamp publish_time = 0;  ///< [ns]
  ByteView data;               ///< owned by whoever made the message
};

struct Chunk {
  Timestamp message_start_time = 0;  ///< [ns]
  Timestamp message_end_time = 0;    ///< [ns]
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;
  ByteView records;  ///< compressed, inside the bytes that were decoded
};

struct MessageIndex {
  std::uint16_t channel_id = 0;
  /// log_time [ns] and offset in the uncompressed chunk.
  std::vector<std::pair<Timestamp, std::uint64_t>> records;
};

struct ChunkIndex {
  Timestamp message_start_time = 0;  ///< [ns]
  Timestamp message_end_time = 0;    ///< [ns]
  std::uint64_t chunk_start_offset = 0;
  std::uint64_t chunk_length = 0;
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  Timestamp log_time = 0;     ///< [ns]
  Timestamp create_time = 0;  ///< [ns]
  std::string name;
  std::string media_type;
  Bytes data;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  Timestamp log_time = 0;     ///< [ns]
  Timestamp create_time = 0;  ///< [ns]
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  Timestamp message_start_time = 0;  ///< [ns]
  Timestamp message_end_time = 0;    ///< [ns]
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> metadata;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct SummaryOffset {
  Opcode group_opcode = Opcode::kHeader;
  std::uint64_t group_start = 0;
  std::uint64_t group_length = 0;
};

struct DataEnd {
  std::uint32_t data_section_crc = 0;
};

}  // namespace swiftlet::mcap
