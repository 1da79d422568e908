// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/repair.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "components/bag/mcap/file_layout.hpp"
#include "components/bag/mcap/salvage.hpp"
#include "components/bag/mcap/writer.hpp"

namespace swiftlet::mcap {
namespace {

Compression compression_of(const std::string& name) {
  for (const Compression known : {Compression::kLz4, Compression::kZstd}) {
    if (name == name_of(known)) return known;
  }
  return Compression::kNone;
}

class Rewriter {
 public:
  Rewriter(const ByteSource& source, const Salvage& found) : source_(source), found_(found) {}

  Status run(const std::filesystem::path& out, const std::string& record) {
    WriterParams params;
    params.profile = found_.header.profile;
    if (!found_.header.library.empty()) params.library = found_.header.library;
    params.compression = compression_of(found_.compression);
    params.overwrite = true;
    auto writer = Writer::open(out, params);
    if (!writer.ok()) return writer.error();
    writer_.emplace(std::move(*writer));
    if (const Status defined = define(); !defined.ok()) return defined;
    for (const RawRecord& raw : found_.records) {
      if (const Status copied = copy(raw); !copied.ok()) return copied;
    }
    const Metadata notes{record,
                         {{"lost_chunks", std::to_string(found_.lost_chunks)},
                          {"lost_messages", std::to_string(lost_messages())},
                          {"skipped_bytes", std::to_string(found_.skipped_bytes)}}};
    if (const Status written = writer_->write(notes); !written.ok()) return written;
    return writer_->close();
  }

  const Statistics& statistics() const { return writer_->statistics(); }
  /// Those that are known by number: of damaged chunks with indexes, of channels that nothing
  /// describes, or of the file's own count.
  std::uint64_t lost_messages() const {
    const std::uint64_t known = found_.lost_messages + undescribed_;
    const std::uint64_t saved = statistics().message_count;
    return std::max(known,
                    found_.counted.value_or(0) - std::min(found_.counted.value_or(0), saved));
  }
  /// Messages of channels that nothing describes.
  std::uint64_t undescribed() const { return undescribed_; }

 private:
  Status define() {
    std::map<std::uint16_t, std::uint16_t> schemas;
    for (const auto& [id, schema] : found_.schemas) {
      const auto added = writer_->add_schema(schema.name, schema.encoding, schema.data);
      if (!added.ok()) return added.error();
      schemas[id] = *added;
    }
    for (const auto& [id, channel] : found_.channels) {
      const auto schema = schemas.find(channel.schema_id);
      const auto added =
          writer_->add_channel(channel.topic, channel.message_encoding,
                               schema == schemas.end() ? 0 : schema->second, channel.metadata);
      if (!added.ok()) return added.error();
      channels_[id] = *added;
    }
    return {};
  }

  Status copy(const RawRecord& raw) {
    const RecordStream stream(source_, raw.offset, raw.end());
    switch (raw.opcode) {
      case Opcode::kChunk:
        return copy_chunk(raw);
      case Opcode::kMetadata: {
        Metadata metadata;
        const Status read = stream.decode_into(raw, metadata, content_);
        return read.ok() ? writer_->write(metadata) : read;
      }
      case Opcode::kAttachment: {
        Attachment attachment;
        bool crc_matches = false;
        if (const Status read = stream.read(raw, content_); !read.ok()) return read;
        if (!decode(content_, attachment, crc_matches)) return stream.malformed(raw);
        return writer_->write(attachment);
      }
      default: {
        Message message;
        const Status read = stream.decode_into(raw, message, content_);
        return read.ok() ? write(message) : read;
      }
    }
  }

  Status copy_chunk(const RawRecord& raw) {
    Chunk chunk;
    const Status read = read_chunk(source_, raw, kMaxChunkSize, content_, chunk, records_);
    if (!read.ok()) return read;
    Status written;
    (void)walk_chunk(
        records_, [](const Schema&) {}, [](const Channel&) {},
        [&](const Message& message, const RawRecord&) {
          if (written.ok()) written = write(message);
        });
    return written;
  }

  Status write(Message message) {
    const auto channel = channels_.find(message.channel_id);
    if (channel == channels_.end()) {
      ++undescribed_;
      return {};
    }
    message.channel_id = channel->second;
    return writer_->write(message);
  }

  const ByteSource& source_;
  const Salvage& found_;
  std::optional<Writer> writer_;
  std::map<std::uint16_t, std::uint16_t> channels_;  // as written, by id in the damaged file
  std::uint64_t undescribed_ = 0;
  Bytes content_;
  Bytes records_;
};

}  // namespace

Result<Repair> repair(const ByteSource& source, const std::filesystem::path& out,
                      const std::string& record) {
  auto found = salvage(source);
  if (!found.ok()) return found.error();
  Rewriter rewriter(source, *found);
  if (const Status written = rewriter.run(out, record); !written.ok()) {
    std::error_code ignored;
    std::filesystem::remove(out, ignored);
    return written.error();
  }
  Repair repair;
  repair.saved = rewriter.statistics();
  repair.lost_chunks = found->lost_chunks;
  repair.lost_messages = rewriter.lost_messages();
  repair.skipped_bytes = found->skipped_bytes;
  repair.problems = std::move(found->problems);
  if (rewriter.undescribed() > 0) {
    repair.problems.push_back(source.name() + ": " + std::to_string(rewriter.undescribed()) +
                              " messages are lost, because nothing describes their channels");
  }
  if (repair.lost_messages > found->lost_messages + rewriter.undescribed()) {
    repair.problems.push_back(source.name() + ": its statistics count " +
                              std::to_string(*found->counted) + " messages, and " +
                              std::to_string(repair.saved.message_count) + " could be saved");
  }
  return repair;
}

}  // namespace swiftlet::mcap
