// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/reader.hpp"

#include <utility>

#include "components/bag/mcap/file_layout.hpp"

namespace swiftlet::mcap {
namespace {

/// The record at a place that an index names, if it is of the kind that the index promises.
Result<RawRecord> find(const ByteSource& source, std::uint64_t offset, std::uint64_t length,
                       Opcode opcode) {
  const std::uint64_t end = length > source.size() ? source.size() : offset + length;
  RecordStream stream(source, offset, end);
  const auto record = stream.next();
  if (!record.ok()) return record.error();
  if (!record->has_value() || (*record)->opcode != opcode) {
    return error_at(source, offset,
                    std::string("the index names a ") + name_of(opcode) +
                        " record here, and there is none; the file is damaged");
  }
  return **record;
}

}  // namespace

Result<Reader> Reader::open(const std::filesystem::path& path, const ReaderParams& params) {
  auto source = open_file(path);
  if (!source.ok()) return source.error();
  return open(std::move(*source), params);
}

Result<Reader> Reader::open(std::shared_ptr<const ByteSource> source, const ReaderParams& params) {
  auto state = std::make_shared<State>();
  state->source = std::move(source);
  state->params = params;
  if (const Status done = read_header(*state->source, state->header, state->data_start);
      !done.ok()) {
    return done.error();
  }
  if (!load_summary(*state)) {
    load_by_scan(*state);
  } else if (!params.use_index) {
    auto scanned = std::make_shared<State>();
    scanned->source = state->source;
    scanned->params = state->params;
    scanned->header = state->header;
    scanned->data_start = state->data_start;
    scanned->finished = state->finished;
    load_by_scan(*scanned);
    state = std::move(scanned);
  }
  return Reader(std::move(state));
}

const std::string& Reader::name() const {
  return state_->source->name();
}
std::uint64_t Reader::size() const {
  return state_->source->size();
}
const Header& Reader::header() const {
  return state_->header;
}
const std::map<std::uint16_t, Schema>& Reader::schemas() const {
  return state_->schemas;
}
const std::map<std::uint16_t, Channel>& Reader::channels() const {
  return state_->channels;
}
const Statistics& Reader::statistics() const {
  return state_->statistics;
}
const std::vector<ChunkIndex>& Reader::chunks() const {
  return state_->chunks;
}
const std::vector<AttachmentIndex>& Reader::attachments() const {
  return state_->attachments;
}
const std::vector<MetadataIndex>& Reader::metadata() const {
  return state_->metadata;
}
bool Reader::finished() const {
  return state_->finished;
}
bool Reader::indexed() const {
  return state_->indexed;
}
const std::vector<Error>& Reader::damage() const {
  return state_->damage;
}

Result<Attachment> Reader::read(const AttachmentIndex& index) const {
  const ByteSource& source = *state_->source;
  const auto record = find(source, index.offset, index.length, Opcode::kAttachment);
  if (!record.ok()) return record.error();
  RecordStream stream(source, index.offset, record->end());
  Bytes content;
  if (const Status done = stream.read(*record, content); !done.ok()) return done.error();
  Attachment attachment;
  bool crc_matches = false;
  if (!decode(content, attachment, crc_matches)) return stream.malformed(*record);
  if (!crc_matches) {
    return error_at(source, index.offset,
                    "attachment \"" + attachment.name +
                        "\" is damaged: its checksum is wrong; everything else can be read");
  }
  return attachment;
}

Result<Metadata> Reader::read(const MetadataIndex& index) const {
  const ByteSource& source = *state_->source;
  const auto record = find(source, index.offset, index.length, Opcode::kMetadata);
  if (!record.ok()) return record.error();
  RecordStream stream(source, index.offset, record->end());
  Bytes content;
  Metadata metadata;
  if (const Status done = stream.decode_into(*record, metadata, content); !done.ok()) {
    return done.error();
  }
  return metadata;
}

}  // namespace swiftlet::mcap
