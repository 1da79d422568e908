// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "components/bag/mcap/file_layout.hpp"

namespace swiftlet::mcap {
namespace {

/// The summary as it stands in the file, before anybody asks if it can be used.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Statistics> statistics;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
};

Status check_crc(const ByteSource& source, const Footer& footer, std::uint64_t footer_offset) {
  if (footer.summary_crc == 0) return {};
  constexpr std::uint64_t kChecked = kRecordPrefixSize + 16;  // the footer up to its checksum
  constexpr std::uint64_t kBlock = 1 << 20;
  const std::uint64_t end = footer_offset + kChecked;
  // Without a summary the checksum covers the footer alone.
  std::uint64_t position = footer.summary_start != 0 ? footer.summary_start : footer_offset;
  std::uint32_t crc = 0;
  Bytes block;
  while (position < end) {
    const std::uint64_t length = std::min(kBlock, end - position);
    if (const Status done = source.read(position, length, block); !done.ok()) return done;
    crc = crc32(block, crc);
    position += length;
  }
  if (crc == footer.summary_crc) return {};
  return error_at(source, footer.summary_start,
                  "the summary is damaged: its checksum is wrong; the file is read from the front");
}

template <class Record>
Status add(const RecordStream& stream, const RawRecord& raw, std::vector<Record>& group,
           Bytes& content) {
  Record record;
  const Status done = stream.decode_into(raw, record, content);
  if (done.ok()) group.push_back(std::move(record));
  return done;
}

template <class Record>
Status add(const RecordStream& stream, const RawRecord& raw, std::map<std::uint16_t, Record>& group,
           Bytes& content) {
  Record record;
  const Status done = stream.decode_into(raw, record, content);
  const std::uint16_t id = record.id;
  if (done.ok()) group.emplace(id, std::move(record));
  return done;
}

Status read_record(const RecordStream& stream, const RawRecord& raw, Summary& summary,
                   Bytes& content) {
  switch (raw.opcode) {
    case Opcode::kSchema:
      return add(stream, raw, summary.schemas, content);
    case Opcode::kChannel:
      return add(stream, raw, summary.channels, content);
    case Opcode::kStatistics:
      return add(stream, raw, summary.statistics, content);
    case Opcode::kChunkIndex:
      return add(stream, raw, summary.chunks, content);
    case Opcode::kAttachmentIndex:
      return add(stream, raw, summary.attachments, content);
    case Opcode::kMetadataIndex:
      return add(stream, raw, summary.metadata, content);
    default:
      return {};
  }
}

/// Everything that reading by index relies on is there, and counted right.
bool is_complete(const Summary& summary) {
  if (summary.statistics.size() != 1) return false;
  const Statistics& counts = summary.statistics.front();
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts.channel_message_counts) {
    if (summary.channels.count(channel) == 0) return false;
    messages += count;
  }
  for (const auto& [id, channel] : summary.channels) {
    if (channel.schema_id != 0 && summary.schemas.count(channel.schema_id) == 0) return false;
  }
  const bool messages_are_indexed = counts.message_count == 0 || !summary.chunks.empty();
  return messages_are_indexed && messages == counts.message_count &&
         summary.chunks.size() == counts.chunk_count &&
         summary.attachments.size() == counts.attachment_count &&
         summary.metadata.size() == counts.metadata_count &&
         summary.channels.size() == counts.channel_count;
}

/// All indexes point into the data section.
template <class Index>
bool lies_inside(const Index& index, std::uint64_t begin, std::uint64_t end) {
  return index.offset >= begin && index.offset <= end && index.length >= kRecordPrefixSize &&
         index.length <= end - index.offset;
}

bool points_into_data(const Summary& summary, std::uint64_t begin, std::uint64_t end) {
  for (const ChunkIndex& index : summary.chunks) {
    const MetadataIndex place{index.chunk_start_offset, index.chunk_length, {}};
    if (!lies_inside(place, begin, end)) return false;
    if (index.message_start_time > index.message_end_time) return false;
  }
  for (const AttachmentIndex& index : summary.attachments) {
    if (!lies_inside(index, begin, end)) return false;
  }
  for (const MetadataIndex& index : summary.metadata) {
    if (!lies_inside(index, begin, end)) return false;
  }
  return true;
}

}  // namespace

bool load_summary(Reader::State& state) {
  const ByteSource& source = *state.source;
  Footer footer;
  std::uint64_t footer_offset = 0;
  const auto damaged = [&](const Error& error) {
    state.damage.push_back(error);
    return false;
  };
  if (const Status done = read_footer(source, footer, footer_offset); !done.ok()) {
    return damaged(done.error());
  }
  state.finished = true;
  if (const Status done = check_crc(source, footer, footer_offset); !done.ok()) {
    return damaged(done.error());
  }
  if (footer.summary_start == 0) return false;  // a file may do without a summary

  Summary summary;
  RecordStream stream(source, footer.summary_start, footer_offset);
  Bytes content;
  for (;;) {
    const auto record = stream.next();
    if (!record.ok()) return damaged(record.error());
    if (!record->has_value()) break;
    const Status done = read_record(stream, **record, summary, content);
    if (!done.ok()) return damaged(done.error());
  }
  if (!is_complete(summary)) return false;
  if (!points_into_data(summary, state.data_start, footer.summary_start)) {
    return damaged(error_at(source, footer.summary_start,
                            "the summary points outside of the data; the file is read from the "
                            "front"));
  }
  std::stable_sort(summary.chunks.begin(), summary.chunks.end(),
                   [](const ChunkIndex& a, const ChunkIndex& b) {
                     return a.chunk_start_offset < b.chunk_start_offset;
                   });
  state.schemas = std::move(summary.schemas);
  state.channels = std::move(summary.channels);
  state.statistics = std::move(summary.statistics.front());
  state.chunks = std::move(summary.chunks);
  state.attachments = std::move(summary.attachments);
  state.metadata = std::move(summary.metadata);
  state.indexed = true;
  return true;
}

}  // namespace swiftlet::mcap
