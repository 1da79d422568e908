// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/bag/mcap/compression.hpp"
#include "components/bag/mcap/records.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet::mcap {

/// The largest chunk that is written, and that the reader accepts unless it is told otherwise.
inline constexpr std::uint64_t kMaxChunkSize = 512ULL << 20;

struct WriterParams {
  std::string profile;                                ///< "ros2" for CDR with ROS 2 types
  std::string library = "swiftlet";                   ///< who wrote the file
  Compression compression = Compression::kZstd;       ///< of chunks
  std::uint64_t chunk_size = 1 << 20;                 ///< uncompressed [bytes]
  Duration chunk_duration = std::chrono::seconds(1);  ///< of log time; 0: only size counts
  bool overwrite = false;                             ///< replace a file that exists

  // Parts of the format that a reader can do without. All on, unless a test wants otherwise.
  bool chunks = true;            ///< off: messages lie in the file one by one, uncompressed
  bool message_index = true;     ///< behind each chunk
  bool chunk_index = true;       ///< in the summary
  bool attachment_index = true;  ///< in the summary
  bool metadata_index = true;    ///< in the summary
  bool repeat_schemas = true;    ///< in the summary
  bool repeat_channels = true;   ///< in the summary
  bool statistics = true;        ///< in the summary
  bool summary_offsets = true;   ///< behind the summary
};

/// Writes an MCAP file. Every chunk goes to the operating system in one piece as soon as it is
/// full, so that a process that is killed leaves a file which Reader opens, but for the last
/// chunk_size bytes or chunk_duration of messages.
///
/// After the first failure (disk full) all calls return that failure, and the file is cut back to
/// its last whole record. Not thread-safe.
class Writer {
 public:
  /// Creates the file and writes its header.
  static Result<Writer> open(const std::filesystem::path& path, WriterParams params = {});

  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  /// Closes the file; call close() to learn whether that went well.
  ~Writer();

  /// The id of the schema; the same id where an equal one was added before.
  Result<std::uint16_t> add_schema(const std::string& name, const std::string& encoding,
                                   ByteView data);
  /// The id of a new channel. `schema_id` 0: the messages have no schema.
  Result<std::uint16_t> add_channel(const std::string& topic, const std::string& message_encoding,
                                    std::uint16_t schema_id,
                                    std::map<std::string, std::string> metadata = {});

  /// Messages need not come in the order of their log times.
  Status write(const Message& message);
  Status write(const Attachment& attachment);
  Status write(const Metadata& metadata);

  /// Of the chunk that is being filled, and of those that follow it.
  void set_compression(Compression compression);

  /// Hands what is in memory to the operating system, as a chunk of its own. A recorder calls it
  /// once a second, so that topics that fell silent are on disk, too.
  Status flush();
  /// Writes the last chunk and the summary, and closes the file. Later calls do nothing.
  Status close();

  const Statistics& statistics() const;
  /// Bytes that the operating system has.
  std::uint64_t size() const;

 private:
  struct State;
  explicit Writer(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace swiftlet::mcap
