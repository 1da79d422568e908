// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "components/bag/mcap/byte_source.hpp"
#include "components/bag/mcap/record_codec.hpp"

namespace swiftlet::mcap {

/// One record of a file or of a decompressed chunk, not yet decoded.
struct RawRecord {
  std::uint64_t offset = 0;  ///< of the opcode: in the file, or in the decompressed chunk
  Opcode opcode = Opcode::kHeader;
  std::uint64_t length = 0;  ///< of the content

  std::uint64_t end() const { return offset + kRecordPrefixSize + length; }
};

/// Walks over the records of a file from one place to another. Contents are read on request only,
/// so that indexes and unknown records cost nothing.
class RecordStream {
 public:
  RecordStream(const ByteSource& source, std::uint64_t begin, std::uint64_t end)
      : source_(&source), position_(begin), end_(end) {}

  /// The next record; nothing at the end. An error where the bytes that are left cannot be a
  /// record; the stream has then ended.
  Result<std::optional<RawRecord>> next();
  /// Overwrites `content` with the content of `record`.
  Status read(const RawRecord& record, Bytes& content) const;
  /// Decodes the content of `record` into `value`, which then owns all that it holds.
  template <class Record>
  Status decode_into(const RawRecord& record, Record& value, Bytes& content) const {
    if (const Status done = read(record, content); !done.ok()) return done;
    if (decode(content, value)) return {};
    return malformed(record);
  }
  Error malformed(const RawRecord& record) const;

 private:
  const ByteSource* source_;
  std::uint64_t position_;
  std::uint64_t end_;
  Bytes prefix_;
};

/// The same for records that lie in memory. Sets `record` to the one at `position` and moves
/// `position` behind it; false where what is left cannot be a record.
[[nodiscard]] bool next_record(ByteView bytes, std::uint64_t& position, RawRecord& record);
inline ByteView content_of(ByteView bytes, const RawRecord& record) {
  return bytes.part(static_cast<std::size_t>(record.offset + kRecordPrefixSize),
                    static_cast<std::size_t>(record.length));
}

/// Checks magic and header at the front of a file. `data_start` is where its data section begins.
Status read_header(const ByteSource& source, Header& header, std::uint64_t& data_start);

/// Checks magic and footer at the end of a file, and that the offsets in it lie in the file.
/// `footer_offset` is where the footer record begins. An error: the file was not closed.
Status read_footer(const ByteSource& source, Footer& footer, std::uint64_t& footer_offset);

/// Decompresses and checks the chunk record at `record`. `chunk.records` becomes empty, the
/// records are in `raw`. Errors name the place in the file.
Status read_chunk(const ByteSource& source, const RawRecord& record, std::uint64_t max_size,
                  Bytes& content, Chunk& chunk, Bytes& raw);

}  // namespace swiftlet::mcap
