// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/record_stream.hpp"

#include <algorithm>
#include <cstring>

#include "components/bag/mcap/compression.hpp"

namespace swiftlet::mcap {
namespace {

constexpr std::uint64_t kMagicSize = sizeof(kMagic);
constexpr std::uint64_t kFooterSize = kRecordPrefixSize + 20;

bool is_magic(const Bytes& bytes) {
  return bytes.size() == kMagicSize && std::equal(bytes.begin(), bytes.end(), std::begin(kMagic));
}

}  // namespace

Result<std::optional<RawRecord>> RecordStream::next() {
  if (position_ >= end_) return std::optional<RawRecord>();
  RawRecord record;
  record.offset = position_;
  const std::uint64_t left = end_ - position_;
  position_ = end_;
  if (left < kRecordPrefixSize) {
    return error_at(*source_, record.offset,
                    "the file ends inside a record; what comes before is intact");
  }
  if (const Status done = source_->read(record.offset, kRecordPrefixSize, prefix_); !done.ok()) {
    return done.error();
  }
  const RecordPrefix prefix = decode_prefix(prefix_);
  record.opcode = prefix.opcode;
  record.length = prefix.length;
  if (static_cast<std::uint8_t>(record.opcode) == 0) {
    return error_at(*source_, record.offset, "no record has opcode 0; what comes before is intact");
  }
  if (record.length > left - kRecordPrefixSize) {
    return error_at(*source_, record.offset,
                    std::string(name_of(record.opcode)) + " record of " +
                        std::to_string(record.length) + " bytes, where only " +
                        std::to_string(left - kRecordPrefixSize) +
                        " are left: the file was cut or is damaged; what comes before is intact");
  }
  position_ = record.end();
  return std::optional<RawRecord>(record);
}

Status RecordStream::read(const RawRecord& record, Bytes& content) const {
  return source_->read(record.offset + kRecordPrefixSize, record.length, content);
}

Error RecordStream::malformed(const RawRecord& record) const {
  return error_at(*source_, record.offset,
                  std::string(name_of(record.opcode)) + " record of " +
                      std::to_string(record.length) +
                      " bytes is damaged: its fields do not fit into it");
}

bool next_record(ByteView bytes, std::uint64_t& position, RawRecord& record) {
  const std::uint64_t left = bytes.size - position;
  if (left < kRecordPrefixSize) return false;
  const RecordPrefix prefix =
      decode_prefix(bytes.part(static_cast<std::size_t>(position), kRecordPrefixSize));
  if (prefix.length > left - kRecordPrefixSize) return false;
  record = {position, prefix.opcode, prefix.length};
  position = record.end();
  return true;
}

Status read_header(const ByteSource& source, Header& header, std::uint64_t& data_start) {
  Bytes bytes;
  const bool readable = source.read(0, std::min(kMagicSize, source.size()), bytes).ok();
  if (!readable || !is_magic(bytes)) {
    return error_at(source, 0,
                    "does not begin as MCAP files do; it is another format, or empty. Give a file "
                    "that `swiftlet bag record` or another MCAP writer made");
  }
  RecordStream stream(source, kMagicSize, source.size());
  const auto record = stream.next();
  if (!record.ok()) return record.error();
  if (!record->has_value() || (*record)->opcode != Opcode::kHeader) {
    return error_at(source, kMagicSize,
                    "the first record must be the header, and is not; the file is damaged or was "
                    "cut at its very beginning, nothing of it can be used");
  }
  data_start = (*record)->end();
  return stream.decode_into(**record, header, bytes);
}

Status read_footer(const ByteSource& source, Footer& footer, std::uint64_t& footer_offset) {
  const std::uint64_t size = source.size();
  const auto unfinished = [&](const std::string& problem) {
    return error_at(source, size,
                    problem +
                        "; the recording was not closed, its messages are found by "
                        "reading it from the front");
  };
  if (size < 2 * kMagicSize + kFooterSize) return unfinished("the file has no footer");
  Bytes bytes;
  if (const Status done = source.read(size - kMagicSize, kMagicSize, bytes); !done.ok()) {
    return done;
  }
  if (!is_magic(bytes)) return unfinished("the file does not end as MCAP files do");
  footer_offset = size - kMagicSize - kFooterSize;
  if (const Status done = source.read(footer_offset, kFooterSize, bytes); !done.ok()) return done;
  const RecordPrefix prefix = decode_prefix(bytes);
  const ByteView content = ByteView(bytes).part(kRecordPrefixSize, kFooterSize - kRecordPrefixSize);
  if (prefix.opcode != Opcode::kFooter || prefix.length != content.size ||
      !decode(content, footer)) {
    return unfinished("the last record is not a footer");
  }
  if (footer.summary_start > footer_offset || footer.summary_offset_start > footer_offset) {
    return error_at(source, footer_offset, "the footer points to a place behind itself");
  }
  return {};
}

Status read_chunk(const ByteSource& source, const RawRecord& record, std::uint64_t max_size,
                  Bytes& content, Chunk& chunk, Bytes& raw) {
  const auto problem = [&](const std::string& what) {
    return error_at(source, record.offset,
                    "chunk " + what + "; its messages are lost, those of other chunks are not");
  };
  if (const Status done = source.read(record.offset + kRecordPrefixSize, record.length, content);
      !done.ok()) {
    return done;
  }
  if (!decode(content, chunk)) return problem("is damaged: its fields do not fit into it");
  if (chunk.uncompressed_size > max_size) {
    return problem("claims " + std::to_string(chunk.uncompressed_size) +
                   " uncompressed bytes, and at most " + std::to_string(max_size) +
                   " are accepted");
  }
  const Status done = decompress(chunk.compression, chunk.records, chunk.uncompressed_size, raw);
  chunk.records = {};
  if (!done.ok()) return problem(done.error().reason);
  if (chunk.uncompressed_crc != 0 && chunk.uncompressed_crc != crc32(raw)) {
    return problem("is damaged: its checksum is wrong");
  }
  return {};
}

}  // namespace swiftlet::mcap
