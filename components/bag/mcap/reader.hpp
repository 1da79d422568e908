// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/mcap/byte_source.hpp"
#include "components/bag/mcap/records.hpp"
#include "components/bag/mcap/writer.hpp"

namespace swiftlet::mcap {

struct ReaderParams {
  bool use_index = true;                         ///< off: always read from the front
  std::uint64_t max_chunk_size = kMaxChunkSize;  ///< uncompressed; larger chunks are refused
  std::uint64_t max_memory = 2ULL << 30;         ///< for chunks that overlap in time [bytes]
};

/// Which messages to read.
struct Filter {
  std::vector<std::string> topics;                         ///< empty: all
  Timestamp first = 0;                                     ///< earliest log time [ns]
  Timestamp last = std::numeric_limits<Timestamp>::max();  ///< latest log time, included [ns]
};

/// A message with what it belongs to.
struct MessageView {
  const Channel* channel = nullptr;  ///< never null
  const Schema* schema = nullptr;    ///< null: the channel has none
  Message message;
};

class MessageCursor;

/// Reads MCAP files, whole or not. A file that was closed is opened through its summary; one that
/// was not (its writer was killed), or whose summary is damaged, is read from the front up to the
/// last whole chunk, and damage() says what was lost.
///
/// Nothing in a file is trusted: lengths are checked against the file, sizes against what really
/// comes out, checksums against the bytes. Errors name file, place, problem and remedy. The
/// channels and schemas that it hands out live as long as one of its copies or cursors does.
class Reader {
 public:
  /// An error where the file cannot be read at all, or is no MCAP file.
  static Result<Reader> open(const std::filesystem::path& path, const ReaderParams& params = {});
  static Result<Reader> open(std::shared_ptr<const ByteSource> source,
                             const ReaderParams& params = {});

  const std::string& name() const;
  std::uint64_t size() const;  ///< of the file [bytes]
  const Header& header() const;
  const std::map<std::uint16_t, Schema>& schemas() const;
  const std::map<std::uint16_t, Channel>& channels() const;
  /// From the summary, or counted.
  const Statistics& statistics() const;
  /// In the order of the file.
  const std::vector<ChunkIndex>& chunks() const;
  const std::vector<AttachmentIndex>& attachments() const;
  const std::vector<MetadataIndex>& metadata() const;

  /// The summary was used, and the data section was not looked at yet.
  bool indexed() const;
  /// The file has its footer. Without: the recording was cut off, its last messages are lost.
  bool finished() const;
  /// What was found wrong when the file was opened; empty for a file that was closed properly.
  /// Damaged chunks show up in MessageCursor::next(), too.
  const std::vector<Error>& damage() const;

  /// Messages by log time; those of the same time in the order of the file.
  MessageCursor messages(Filter filter = {}) const;
  Result<Attachment> read(const AttachmentIndex& index) const;
  Result<Metadata> read(const MetadataIndex& index) const;

  struct State;

 private:
  explicit Reader(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// One pass over the messages of a file.
class MessageCursor {
 public:
  MessageCursor(MessageCursor&&) noexcept;
  MessageCursor& operator=(MessageCursor&&) noexcept;
  ~MessageCursor();

  /// The next message, valid until the next call; nothing at the end. An error concerns one chunk,
  /// whose messages are lost: the call after it goes on with those of the others.
  Result<std::optional<MessageView>> next();

 private:
  friend class Reader;
  struct Impl;
  explicit MessageCursor(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::mcap
