// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/records.hpp"

#include <zlib.h>

#include <iterator>

namespace swiftlet::mcap {

std::uint32_t crc32(ByteView bytes, std::uint32_t crc) {
  if (bytes.size == 0) return crc;  // zlib starts anew when it is given no buffer
  return static_cast<std::uint32_t>(::crc32_z(crc, bytes.data, bytes.size));
}

const char* name_of(Opcode opcode) {
  static constexpr const char* kNames[] = {
      "unknown",  "Header",        "Footer",        "Schema",     "Channel",         "Message",
      "Chunk",    "MessageIndex",  "ChunkIndex",    "Attachment", "AttachmentIndex", "Statistics",
      "Metadata", "MetadataIndex", "SummaryOffset", "DataEnd"};
  const auto index = static_cast<std::size_t>(opcode);
  return index < std::size(kNames) ? kNames[index] : kNames[0];
}

bool operator==(const Schema& a, const Schema& b) {
  return a.id == b.id && a.name == b.name && a.encoding == b.encoding && a.data == b.data;
}

bool operator==(const Channel& a, const Channel& b) {
  return a.id == b.id && a.schema_id == b.schema_id && a.topic == b.topic &&
         a.message_encoding == b.message_encoding && a.metadata == b.metadata;
}

}  // namespace swiftlet::mcap
