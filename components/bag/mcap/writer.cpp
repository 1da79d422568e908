// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "components/bag/mcap/record_codec.hpp"

namespace swiftlet::mcap {
namespace {

constexpr std::size_t kMaxId = 65535;
/// Larger than the fields of any message record.
constexpr std::uint64_t kMessageOverhead = 64;

/// A file that is only appended to, with the CRC of all its bytes.
class AppendFile {
 public:
  AppendFile() = default;
  ~AppendFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  Status open(const std::filesystem::path& path, bool overwrite) {
    path_ = path.string();
    const int mode = O_WRONLY | O_CREAT | O_CLOEXEC | (overwrite ? O_TRUNC : O_EXCL);
    descriptor_ = ::open(path.c_str(), mode, 0644);
    if (descriptor_ >= 0) return {};
    if (errno == EEXIST) {
      return Error{path_ + ": exists already; choose another name or remove it first"};
    }
    return Error{path_ + ": cannot be created: " + strerror(errno)};
  }

  /// All of `bytes`, or none of them.
  Status append(ByteView bytes) {
    std::size_t done = 0;
    while (done < bytes.size) {
      const ssize_t count = ::write(descriptor_, bytes.data + done, bytes.size - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return give_up(count < 0 ? strerror(errno) : "nothing more is accepted");
      done += static_cast<std::size_t>(count);
    }
    size_ += bytes.size;
    crc_ = crc32(bytes, crc_);
    return {};
  }

  Status close() {
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor < 0 || ::close(descriptor) == 0) return {};
    return Error{path_ + ": byte " + std::to_string(size_) +
                 ": cannot be closed: " + strerror(errno) + "; check the disk"};
  }

  std::uint64_t size() const { return size_; }
  std::uint32_t crc() const { return crc_; }
  const std::string& path() const { return path_; }

 private:
  Status give_up(const char* reason) {
    const Error error{path_ + ": byte " + std::to_string(size_) + ": cannot be written: " + reason +
                      "; everything before this place is kept, free some space and start again"};
    if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) {
      // A device that cannot be cut; readers skip the incomplete record.
    }
    return error;
  }

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;
};

/// The chunk that is being filled.
struct OpenChunk {
  Bytes records;
  Timestamp start = 0;
  Timestamp end = 0;
  bool has_messages = false;
  std::map<std::uint16_t, MessageIndex> indexes;

  void clear() {
    records.clear();
    has_messages = false;
    start = end = 0;
    indexes.clear();
  }
};

void include(Timestamp time, bool first, Timestamp& start, Timestamp& end) {
  start = first ? time : std::min(start, time);
  end = first ? time : std::max(end, time);
}

}  // namespace

struct Writer::State {
  WriterParams params;
  AppendFile file;
  bool closed = false;
  Status failure;

  OpenChunk chunk;
  Bytes buffer;      // of the records that go out next
  Bytes compressed;  // of the chunk that goes out next

  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  std::vector<ChunkIndex> chunk_indexes;
  std::vector<AttachmentIndex> attachment_indexes;
  std::vector<MetadataIndex> metadata_indexes;
  Statistics statistics;

  /// Where schemas, channels and messages go.
  Bytes& records() { return params.chunks ? chunk.records : buffer; }

  Status usable() const {
    if (!failure.ok()) return failure;
    if (closed) return Error{file.path() + ": is closed, nothing more can be written"};
    return {};
  }

  Status write_buffer() {
    failure = file.append(buffer);
    buffer.clear();
    return failure;
  }

  /// Without chunks, what was added goes to the file at once.
  Status after_record() { return params.chunks ? Status() : write_buffer(); }

  Status write_chunk();
  void append_message_indexes(std::uint64_t start, ChunkIndex& index);
  Status write_end();
  template <class Records>
  void append_group(const Records& group, Opcode opcode, std::vector<SummaryOffset>& offsets);
};

Status Writer::State::write_chunk() {
  if (chunk.records.empty()) return {};
  Chunk record;
  record.message_start_time = chunk.start;
  record.message_end_time = chunk.end;
  record.uncompressed_size = chunk.records.size();
  record.uncompressed_crc = crc32(chunk.records);
  record.records = chunk.records;
  if (params.compression != Compression::kNone) {
    if (const Status done = compress(params.compression, chunk.records, compressed); !done.ok()) {
      failure = Error{file.path() + ": " + done.error().reason};
      return failure;
    }
    if (compressed.size() < chunk.records.size()) {  // pictures are often compressed already
      record.compression = name_of(params.compression);
      record.records = compressed;
    }
  }

  ChunkIndex index;
  index.message_start_time = record.message_start_time;
  index.message_end_time = record.message_end_time;
  index.chunk_start_offset = file.size();
  index.compression = record.compression;
  index.compressed_size = record.records.size;
  index.uncompressed_size = record.uncompressed_size;
  append(buffer, record);
  index.chunk_length = buffer.size();
  if (params.message_index) append_message_indexes(file.size(), index);
  if (const Status done = write_buffer(); !done.ok()) return done;

  chunk_indexes.push_back(std::move(index));
  ++statistics.chunk_count;
  chunk.clear();
  return {};
}

void Writer::State::append_message_indexes(std::uint64_t start, ChunkIndex& index) {
  const std::size_t before = buffer.size();
  for (const auto& [channel_id, message_index] : chunk.indexes) {
    index.message_index_offsets[channel_id] = start + buffer.size();
    append(buffer, message_index);
  }
  index.message_index_length = buffer.size() - before;
}

template <class Records>
void Writer::State::append_group(const Records& group, Opcode opcode,
                                 std::vector<SummaryOffset>& offsets) {
  const std::size_t before = buffer.size();
  for (const auto& record : group) append(buffer, record);
  if (buffer.size() == before) return;
  offsets.push_back({opcode, file.size() + before, buffer.size() - before});
}

Status Writer::State::write_end() {
  append(buffer, DataEnd{file.crc()});
  if (const Status done = write_buffer(); !done.ok()) return done;

  Footer footer;
  std::vector<SummaryOffset> offsets;
  const auto wanted = [](bool flag, const auto& group) {
    return flag ? group : std::decay_t<decltype(group)>();
  };
  append_group(wanted(params.repeat_schemas, schemas), Opcode::kSchema, offsets);
  append_group(wanted(params.repeat_channels, channels), Opcode::kChannel, offsets);
  append_group(wanted(params.statistics, std::vector<Statistics>{statistics}), Opcode::kStatistics,
               offsets);
  append_group(wanted(params.metadata_index, metadata_indexes), Opcode::kMetadataIndex, offsets);
  append_group(wanted(params.attachment_index, attachment_indexes), Opcode::kAttachmentIndex,
               offsets);
  append_group(wanted(params.chunk_index, chunk_indexes), Opcode::kChunkIndex, offsets);
  if (!offsets.empty()) {
    footer.summary_start = file.size();
    if (params.summary_offsets) {
      footer.summary_offset_start = file.size() + buffer.size();
      for (const SummaryOffset& offset : offsets) append(buffer, offset);
    }
  }
  append(buffer, footer);
  // The checksum covers the summary and the footer up to itself.
  footer.summary_crc = crc32(ByteView(buffer.data(), buffer.size() - sizeof(footer.summary_crc)));
  buffer.resize(buffer.size() - kRecordPrefixSize - 20);
  append(buffer, footer);
  buffer.insert(buffer.end(), std::begin(kMagic), std::end(kMagic));
  return write_buffer();
}

Writer::Writer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Writer::Writer(Writer&&) noexcept = default;

Writer& Writer::operator=(Writer&& other) noexcept {
  if (this != &other) {
    if (state_) (void)close();
    state_ = std::move(other.state_);
  }
  return *this;
}

Writer::~Writer() {
  if (state_) (void)close();
}

Result<Writer> Writer::open(const std::filesystem::path& path, WriterParams params) {
  auto state = std::make_unique<State>();
  if (const Status opened = state->file.open(path, params.overwrite); !opened.ok()) {
    return opened.error();
  }
  state->buffer.assign(std::begin(kMagic), std::end(kMagic));
  append(state->buffer, Header{params.profile, params.library});
  state->params = std::move(params);
  if (const Status written = state->write_buffer(); !written.ok()) return written.error();
  return Writer(std::move(state));
}

Result<std::uint16_t> Writer::add_schema(const std::string& name, const std::string& encoding,
                                         ByteView data) {
  State& s = *state_;
  if (const Status usable = s.usable(); !usable.ok()) return usable.error();
  Schema schema{0, name, encoding, data.copy()};
  for (const Schema& known : s.schemas) {
    schema.id = known.id;
    if (known == schema) return known.id;
  }
  if (s.schemas.size() >= kMaxId) return Error{s.file.path() + ": has 65535 schemas already"};
  schema.id = static_cast<std::uint16_t>(s.schemas.size() + 1);
  append(s.records(), schema);
  s.schemas.push_back(std::move(schema));
  s.statistics.schema_count = static_cast<std::uint16_t>(s.schemas.size());
  if (const Status done = s.after_record(); !done.ok()) return done.error();
  return s.schemas.back().id;
}

Result<std::uint16_t> Writer::add_channel(const std::string& topic,
                                          const std::string& message_encoding,
                                          std::uint16_t schema_id,
                                          std::map<std::string, std::string> metadata) {
  State& s = *state_;
  if (const Status usable = s.usable(); !usable.ok()) return usable.error();
  if (schema_id > s.schemas.size()) {
    return Error{s.file.path() + ": topic \"" + topic + "\" names schema " +
                 std::to_string(schema_id) + ", which was not added"};
  }
  if (s.channels.size() >= kMaxId) return Error{s.file.path() + ": has 65535 channels already"};
  Channel channel{static_cast<std::uint16_t>(s.channels.size() + 1), schema_id, topic,
                  message_encoding, std::move(metadata)};
  append(s.records(), channel);
  s.channels.push_back(std::move(channel));
  s.statistics.channel_count = static_cast<std::uint32_t>(s.channels.size());
  if (const Status done = s.after_record(); !done.ok()) return done.error();
  return s.channels.back().id;
}

Status Writer::write(const Message& message) {
  State& s = *state_;
  if (const Status usable = s.usable(); !usable.ok()) return usable;
  if (message.channel_id == 0 || message.channel_id > s.channels.size()) {
    return Error{s.file.path() + ": a message names channel " + std::to_string(message.channel_id) +
                 ", which was not added"};
  }
  if (message.data.size > kMaxChunkSize - kMessageOverhead) {
    return Error{s.file.path() + ": a message on \"" + s.channels[message.channel_id - 1U].topic +
                 "\" has " + std::to_string(message.data.size) + " bytes; at most " +
                 std::to_string(kMaxChunkSize - kMessageOverhead) + " are possible"};
  }
  OpenChunk& chunk = s.chunk;
  const bool too_large =
      chunk.records.size() + message.data.size + kMessageOverhead > kMaxChunkSize;
  const Timestamp span =
      static_cast<Timestamp>(std::max<Duration::rep>(s.params.chunk_duration.count(), 0));
  const bool too_long =
      span > 0 && chunk.has_messages &&
      std::max(chunk.end, message.log_time) - std::min(chunk.start, message.log_time) >= span;
  if (s.params.chunks && (too_large || too_long)) {
    if (const Status done = s.write_chunk(); !done.ok()) return done;
  }

  const std::uint64_t offset = chunk.records.size();
  append(s.records(), message);
  Statistics& total = s.statistics;
  include(message.log_time, total.message_count == 0, total.message_start_time,
          total.message_end_time);
  ++total.message_count;
  ++total.channel_message_counts[message.channel_id];
  if (!s.params.chunks) return s.write_buffer();

  include(message.log_time, !chunk.has_messages, chunk.start, chunk.end);
  chunk.has_messages = true;
  MessageIndex& index = chunk.indexes[message.channel_id];
  index.channel_id = message.channel_id;
  index.records.emplace_back(message.log_time, offset);
  return chunk.records.size() >= s.params.chunk_size ? s.write_chunk() : Status();
}

Status Writer::write(const Attachment& attachment) {
  State& s = *state_;
  if (const Status usable = s.usable(); !usable.ok()) return usable;
  AttachmentIndex index;
  index.offset = s.file.size();
  index.log_time = attachment.log_time;
  index.create_time = attachment.create_time;
  index.data_size = attachment.data.size();
  index.name = attachment.name;
  index.media_type = attachment.media_type;
  append(s.buffer, attachment);
  index.length = s.buffer.size();
  if (const Status done = s.write_buffer(); !done.ok()) return done;
  s.attachment_indexes.push_back(std::move(index));
  ++s.statistics.attachment_count;
  return {};
}

Status Writer::write(const Metadata& metadata) {
  State& s = *state_;
  if (const Status usable = s.usable(); !usable.ok()) return usable;
  MetadataIndex index{s.file.size(), 0, metadata.name};
  append(s.buffer, metadata);
  index.length = s.buffer.size();
  if (const Status done = s.write_buffer(); !done.ok()) return done;
  s.metadata_indexes.push_back(std::move(index));
  ++s.statistics.metadata_count;
  return {};
}

void Writer::set_compression(Compression compression) {
  state_->params.compression = compression;
}

Status Writer::flush() {
  if (const Status usable = state_->usable(); !usable.ok()) return usable;
  return state_->write_chunk();
}

Status Writer::close() {
  State& s = *state_;
  if (s.closed) return s.failure;
  Status done = s.failure;
  if (done.ok()) done = s.write_chunk();
  if (done.ok()) done = s.write_end();
  s.closed = true;
  const Status closed = s.file.close();
  if (done.ok()) s.failure = closed;
  return s.failure;
}

const Statistics& Writer::statistics() const {
  return state_->statistics;
}
std::uint64_t Writer::size() const {
  return state_->file.size();
}

}  // namespace swiftlet::mcap
