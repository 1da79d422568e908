// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/record_stream.hpp"

namespace swiftlet::mcap {

/// What can be had from a file, whatever happened to it.
struct Salvage {
  Header header;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  /// Sound chunks, messages outside of chunks, attachments and metadata, in the order of the file.
  std::vector<RawRecord> records;
  std::string compression;               ///< of the first chunk
  std::optional<std::uint64_t> counted;  ///< messages, if the statistics are there
  std::uint64_t lost_chunks = 0;         ///< that were there, and are damaged
  std::uint64_t lost_messages = 0;       ///< of these, as far as their indexes say
  std::uint64_t skipped_bytes = 0;       ///< that are part of nothing known
  std::vector<std::string> problems;     ///< what cannot be had, each with its place
};

/// Looks at every byte. Behind a place where nothing makes sense, it goes on at the next chunk or
/// attachment whose checksum is right. In a file with chunks, messages outside of them are not
/// believed: a changed bit makes one of an index. Types and topics are taken from wherever they are
/// described, the summary included. An error where nothing in the file is of MCAP.
Result<Salvage> salvage(const ByteSource& source, const ReaderParams& params = {});

}  // namespace swiftlet::mcap
