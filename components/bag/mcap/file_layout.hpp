// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/record_stream.hpp"

namespace swiftlet::mcap {

/// A message that lies in the data section, outside of any chunk.
struct LooseMessage {
  Timestamp log_time = 0;
  RawRecord record;
};

/// What Reader knows about a file once it is open: everything but the messages.
struct Reader::State {
  std::shared_ptr<const ByteSource> source;
  ReaderParams params;
  Header header;
  std::uint64_t data_start = 0;
  bool finished = false;
  bool indexed = false;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  Statistics statistics;
  std::vector<ChunkIndex> chunks;
  std::vector<LooseMessage> loose_messages;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  std::vector<Error> damage;
};

/// Fills in `state` from the summary. False where there is none, or it lacks something that
/// reading by index needs, or disagrees with itself; what is damaged goes to `state.damage`.
bool load_summary(Reader::State& state);

/// Fills in `state` by reading the data section from the front up to the first place that cannot
/// be read.
void load_by_scan(Reader::State& state);

/// Finds the messages in the records of a decompressed chunk: calls `on_schema`, `on_channel` and
/// `on_message(message, record)` in their order. What is wrong, or "".
template <class OnSchema, class OnChannel, class OnMessage>
std::string walk_chunk(ByteView raw, OnSchema&& on_schema, OnChannel&& on_channel,
                       OnMessage&& on_message) {
  std::uint64_t position = 0;
  RawRecord record;
  while (position < raw.size) {
    if (!next_record(raw, position, record)) {
      return "has an incomplete record at byte " + std::to_string(position) + " of its records";
    }
    const ByteView content = content_of(raw, record);
    bool decoded = true;
    if (record.opcode == Opcode::kMessage) {
      Message message;
      if ((decoded = decode(content, message))) on_message(message, record);
    } else if (record.opcode == Opcode::kSchema) {
      Schema schema;
      if ((decoded = decode(content, schema))) on_schema(schema);
    } else if (record.opcode == Opcode::kChannel) {
      Channel channel;
      if ((decoded = decode(content, channel))) on_channel(channel);
    }
    if (!decoded) {
      return std::string("has a damaged ") + name_of(record.opcode) + " record at byte " +
             std::to_string(record.offset) + " of its records";
    }
  }
  return {};
}

}  // namespace swiftlet::mcap
