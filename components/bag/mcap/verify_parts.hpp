// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "components/bag/mcap/record_stream.hpp"
#include "components/bag/mcap/verify.hpp"

/// The two halves of verify(), and what they share.
namespace swiftlet::mcap {

/// Problems found so far, each with its place.
class Findings {
 public:
  explicit Findings(const ByteSource& source) : source_(source) {}

  const ByteSource& source() const { return source_; }
  Verification& result() { return result_; }

  void problem(std::string what);
  void problem_at(std::uint64_t offset, const std::string& what);
  void remark_at(std::uint64_t offset, const std::string& what);
  /// A record that is none of those that belong where it is.
  void foreign_record(const RawRecord& raw, const std::string& section);
  /// The CRC of a part of the file, read in pieces.
  std::optional<std::uint32_t> crc_of(std::uint64_t begin, std::uint64_t end);

  template <class Record>
  std::optional<Record> decoded(const RecordStream& stream, const RawRecord& raw) {
    Record record;
    const Status done = stream.decode_into(raw, record, content_);
    if (done.ok()) return record;
    problem(done.error().reason);
    return std::nullopt;
  }

 private:
  const ByteSource& source_;
  Verification result_;
  Bytes content_;
};

/// What the data section really holds; indexes by their offset in the file.
struct Contents {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::map<std::uint64_t, ChunkIndex> chunks;
  std::map<std::uint64_t, AttachmentIndex> attachments;
  std::map<std::uint64_t, MetadataIndex> metadata;
  std::uint64_t end = 0;
  bool lost_messages = false;  ///< a damaged chunk: counts and definitions are incomplete
};

/// True where the end of the data section was reached and the summary may follow.
bool verify_data(RecordStream& stream, const ReaderParams& params, Findings& findings,
                 Contents& contents);

/// Compares what the summary says with what is there.
void verify_summary(RecordStream& stream, const Footer& footer, std::uint64_t footer_offset,
                    Findings& findings, const Contents& contents);

}  // namespace swiftlet::mcap
