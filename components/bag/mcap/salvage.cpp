// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/salvage.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "components/bag/mcap/file_layout.hpp"

namespace swiftlet::mcap {
namespace {

constexpr std::size_t kMaxProblems = 100;
/// Records in a row that must make sense before the end of a damaged one is believed.
constexpr int kBelievable = 3;
/// How often, on average, a byte may be read in search of the next sound chunk: files that are made
/// to keep us busy must not.
constexpr std::uint64_t kMaxEffort = 8;

class Salvager {
 public:
  Salvager(const ByteSource& source, const ReaderParams& params)
      : source_(source), params_(params) {}

  Result<Salvage> run() {
    std::uint64_t position = 0;
    const Status header = read_header(source_, found_.header, position);
    if (!header.ok()) {
      problem(header.error().reason);
      position = next_sound(0);
    }
    while (position < source_.size() && !is_magic(position)) position = take(position);
    close_lost_chunk();
    leave_out_loose_messages();
    if (!header.ok() && found_.records.empty()) return header.error();
    return std::move(found_);
  }

 private:
  void leave_out_loose_messages() {
    auto& records = found_.records;
    const auto is = [](Opcode opcode) {
      return [opcode](const RawRecord& record) { return record.opcode == opcode; };
    };
    if (std::none_of(records.begin(), records.end(), is(Opcode::kChunk))) return;
    const auto loose = std::find_if(records.begin(), records.end(), is(Opcode::kMessage));
    if (loose == records.end()) return;
    problem(error_at(source_, loose->offset,
                     "messages outside of chunks, in a file that has chunks, are left out: nothing "
                     "says that they are sound")
                .reason);
    records.erase(std::remove_if(loose, records.end(), is(Opcode::kMessage)), records.end());
  }

  /// The magic bytes at the end of a file, and nothing behind them.
  bool is_magic(std::uint64_t position) {
    if (source_.size() - position != sizeof(kMagic)) return false;
    return source_.read(position, sizeof(kMagic), content_).ok() &&
           std::equal(content_.begin(), content_.end(), std::begin(kMagic));
  }

  void problem(std::string what) {
    if (found_.problems.size() < kMaxProblems) found_.problems.push_back(std::move(what));
  }

  std::optional<RawRecord> record_at(std::uint64_t position) const {
    RecordStream stream(source_, position, source_.size());
    const auto record = stream.next();
    if (!record.ok() || !record->has_value()) return std::nullopt;
    return **record;
  }

  /// Takes what is at `position`, and says where to go on.
  std::uint64_t take(std::uint64_t position) {
    const auto record = record_at(position);
    if (record && record->opcode != Opcode::kMessageIndex) close_lost_chunk();
    Status taken = record ? take(*record) : Error{"no record begins here"};
    if (taken.ok()) return record->end();
    if (record && record->opcode == Opcode::kChunk) {
      ++found_.lost_chunks;
      lost_chunk_ = taken.error().reason;
    } else {
      problem(record ? taken.error().reason : error_at(source_, position, cut_or_damaged()).reason);
    }
    if (record && is_believable(record->end())) return record->end();
    const std::uint64_t next = next_sound(position + 1);
    found_.skipped_bytes += next - position;
    return next;
  }

  static std::string cut_or_damaged() {
    return "the file was cut or is damaged here; nothing up to the next sound chunk can be read";
  }

  Status take(const RawRecord& record) {
    const RecordStream stream(source_, record.offset, record.end());
    switch (record.opcode) {
      case Opcode::kSchema:
        return decoded<Schema>(stream, record, [this](Schema& schema) { add(schema); });
      case Opcode::kChannel:
        return decoded<Channel>(stream, record, [this](Channel& channel) { add(channel); });
      case Opcode::kMessage:
        return decoded<Message>(stream, record, [&](Message&) { keep(record); });
      case Opcode::kMetadata:
        return decoded<Metadata>(stream, record, [&](Metadata&) { keep(record); });
      case Opcode::kAttachment:
        return take_attachment(stream, record);
      case Opcode::kChunk:
        return take_chunk(record);
      case Opcode::kMessageIndex:
        return take_message_index(stream, record);
      case Opcode::kStatistics:
        return decoded<Statistics>(stream, record, [this](const Statistics& statistics) {
          found_.counted = statistics.message_count;
        });
      default:
        return take_other(record);
    }
  }

  template <class Record, class Use>
  Status decoded(const RecordStream& stream, const RawRecord& raw, Use&& use) {
    Record value;
    if (const Status done = stream.decode_into(raw, value, content_); !done.ok()) return done;
    use(value);
    return {};
  }

  Status take_message_index(const RecordStream& stream, const RawRecord& record) {
    constexpr std::uint64_t kFixed = 6, kEntry = 16;
    MessageIndex index;
    if (const Status done = stream.decode_into(record, index, content_); !done.ok()) return done;
    // A chunk with a changed opcode would pass for an index with something behind it.
    if (record.length != kFixed + kEntry * index.records.size()) return stream.malformed(record);
    if (lost_chunk_) lost_counts_[index.channel_id] += index.records.size();
    return {};
  }

  /// Indexes, which are made anew, and what only later versions of the format know.
  Status take_other(const RawRecord& record) {
    static const std::map<Opcode, std::uint64_t> kLengths = {
        {Opcode::kDataEnd, 4}, {Opcode::kFooter, 20}, {Opcode::kSummaryOffset, 17}};
    const auto length = kLengths.find(record.opcode);
    const bool right_length = length == kLengths.end() || length->second == record.length;
    if (right_length && record.opcode > Opcode::kHeader && record.opcode <= Opcode::kDataEnd) {
      return {};
    }
    return error_at(source_, record.offset,
                    "a record of " + std::to_string(record.length) +
                        " bytes that is of no known kind, or does not belong here, is left out");
  }

  Status take_attachment(const RecordStream& stream, const RawRecord& record) {
    Attachment attachment;
    bool crc_matches = false;
    if (const Status done = stream.read(record, content_); !done.ok()) return done;
    if (!decode(content_, attachment, crc_matches)) return stream.malformed(record);
    if (!crc_matches) {
      return error_at(source_, record.offset,
                      "attachment \"" + attachment.name + "\" is lost: its checksum is wrong");
    }
    keep(record);
    return {};
  }

  Status take_chunk(const RawRecord& record) {
    Chunk chunk;
    const Status read =
        read_chunk(source_, record, params_.max_chunk_size, content_, chunk, records_);
    if (!read.ok()) return read;
    std::vector<Schema> schemas;
    std::vector<Channel> channels;
    const std::string wrong = walk_chunk(
        records_, [&](Schema& schema) { schemas.push_back(std::move(schema)); },
        [&](Channel& channel) { channels.push_back(std::move(channel)); },
        [](const Message&, const RawRecord&) {});
    if (!wrong.empty()) return error_at(source_, record.offset, "chunk " + wrong);
    for (Schema& schema : schemas) add(schema);
    for (Channel& channel : channels) add(channel);
    if (found_.compression.empty()) found_.compression = chunk.compression;
    keep(record);
    return {};
  }

  void keep(const RawRecord& record) { found_.records.push_back(record); }

  void add(Schema& schema) {
    if (schema.id == 0) return;
    const auto [known, is_new] = found_.schemas.emplace(schema.id, schema);
    if (!is_new && !(known->second == schema)) {
      problem(source_.name() + ": schema " + std::to_string(schema.id) +
              " is described twice, and differently; the first description is used");
    }
  }

  void add(Channel& channel) {
    const auto [known, is_new] = found_.channels.emplace(channel.id, channel);
    if (!is_new && !(known->second == channel)) {
      problem(source_.name() + ": channel " + std::to_string(channel.id) +
              " is described twice, and differently; the first description is used");
    }
  }

  /// Says what a damaged chunk held, once its indexes are behind us.
  void close_lost_chunk() {
    if (!lost_chunk_) return;
    std::uint64_t messages = 0;
    std::string topics;
    for (const auto& [id, count] : lost_counts_) {
      messages += count;
      const auto channel = found_.channels.find(id);
      topics += (topics.empty() ? "" : ", ") +
                (channel == found_.channels.end() ? "channel " + std::to_string(id)
                                                  : channel->second.topic) +
                " " + std::to_string(count);
    }
    found_.lost_messages += messages;
    if (messages > 0) *lost_chunk_ += "; it held " + std::to_string(messages) + ": " + topics;
    problem(std::move(*lost_chunk_));
    lost_chunk_.reset();
    lost_counts_.clear();
  }

  /// Whether what follows a damaged record looks as if the record did end there.
  bool is_believable(std::uint64_t position) {
    for (int i = 0; i < kBelievable; ++i) {
      if (position >= source_.size() || is_magic(position)) return true;
      const auto record = record_at(position);
      if (!record || record->opcode > Opcode::kDataEnd) return false;
      position = record->end();
    }
    return true;
  }

  /// The first chunk or attachment from `position` on whose checksum is right; the end of the file
  /// where there is none.
  std::uint64_t next_sound(std::uint64_t position) {
    constexpr std::uint64_t kBlock = 1 << 20;
    Bytes block;
    while (position < source_.size()) {
      const std::uint64_t length = std::min(kBlock, source_.size() - position);
      if (!source_.read(position, length, block).ok()) break;
      for (std::size_t i = 0; i < block.size(); ++i) {
        const auto opcode = static_cast<Opcode>(block[i]);
        if (opcode != Opcode::kChunk && opcode != Opcode::kAttachment) continue;
        if (is_sound(position + i)) return position + i;
      }
      position += length;
    }
    return source_.size();
  }

  bool is_sound(std::uint64_t position) {
    const auto record = record_at(position);
    if (!record) return false;
    if (record->opcode == Opcode::kChunk && !looks_like_chunk(*record)) return false;
    effort_ += record->length;
    if (effort_ > kMaxEffort * (source_.size() + (1 << 20))) return false;
    if (!source_.read(record->offset + kRecordPrefixSize, record->length, content_).ok()) {
      return false;
    }
    if (record->opcode == Opcode::kAttachment) {
      Attachment attachment;
      bool crc_matches = false;
      return decode(content_, attachment, crc_matches) && crc_matches &&
             crc_is_given(content_.end() - 4, content_.end());
    }
    Chunk chunk;
    return read_chunk(source_, *record, params_.max_chunk_size, content_, chunk, records_).ok();
  }

  template <class Iterator>
  static bool crc_is_given(Iterator begin, Iterator end) {
    return std::any_of(begin, end, [](auto byte) { return byte != 0; });
  }

  /// By its first fields, before all of it is read and decompressed.
  bool looks_like_chunk(const RawRecord& record) {
    constexpr std::uint64_t kLongestName = 4;  // "zstd"
    constexpr std::uint64_t kFixed = 8 + 8 + 8 + 4 + 4 + 8;
    if (record.length < kFixed) return false;
    const std::uint64_t front = std::min(record.length, kFixed + kLongestName);
    if (!source_.read(record.offset + kRecordPrefixSize, front, content_).ok()) return false;
    const auto number = [this](std::size_t at, int bytes) {
      std::uint64_t value = 0;
      for (int i = bytes; i-- > 0;) value = value << 8 | content_[at + static_cast<std::size_t>(i)];
      return value;
    };
    const std::uint64_t name_length = number(28, 4);
    return number(0, 8) <= number(8, 8) && number(16, 8) <= params_.max_chunk_size &&
           number(24, 4) != 0 && name_length <= kLongestName &&
           kFixed + name_length <= record.length &&
           number(32 + static_cast<std::size_t>(name_length), 8) ==
               record.length - kFixed - name_length;
  }

  const ByteSource& source_;
  const ReaderParams& params_;
  Salvage found_;
  std::optional<std::string> lost_chunk_;
  std::map<std::uint16_t, std::uint64_t> lost_counts_;
  std::uint64_t effort_ = 0;
  Bytes content_;
  Bytes records_;
};

}  // namespace

Result<Salvage> salvage(const ByteSource& source, const ReaderParams& params) {
  return Salvager(source, params).run();
}

}  // namespace swiftlet::mcap
