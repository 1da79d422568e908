// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <utility>

#include "components/bag/mcap/verify_parts.hpp"

namespace swiftlet::mcap {
namespace {

bool same(const ChunkIndex& a, const ChunkIndex& b) {
  return a.message_start_time == b.message_start_time && a.message_end_time == b.message_end_time &&
         a.chunk_length == b.chunk_length && a.compression == b.compression &&
         a.compressed_size == b.compressed_size && a.uncompressed_size == b.uncompressed_size;
}

bool same(const AttachmentIndex& a, const AttachmentIndex& b) {
  return a.length == b.length && a.log_time == b.log_time && a.create_time == b.create_time &&
         a.data_size == b.data_size && a.name == b.name && a.media_type == b.media_type;
}

bool same(const MetadataIndex& a, const MetadataIndex& b) {
  return a.length == b.length && a.name == b.name;
}

class SummaryVerifier {
 public:
  SummaryVerifier(Findings& findings, const Contents& contents)
      : findings_(findings), contents_(contents), counted_(findings.result().counted) {}

  void run(RecordStream& stream, const Footer& footer, std::uint64_t footer_offset) {
    const std::uint64_t start = footer.summary_start != 0 ? footer.summary_start : footer_offset;
    if (footer.summary_start != 0 && footer.summary_start != contents_.end) {
      findings_.problem_at(footer_offset,
                           "the footer gives another place of the summary than it has");
    }
    if (footer.summary_crc != 0 && start <= footer_offset) {
      const auto crc = findings_.crc_of(start, footer_offset + kRecordPrefixSize + 16);
      if (crc && *crc != footer.summary_crc) {
        findings_.problem_at(start, "the summary is damaged: its checksum is wrong");
      }
    }
    std::set<Opcode> ended_groups;
    std::optional<Opcode> group;
    for (;;) {
      const auto record = stream.next();
      if (!record.ok()) return findings_.problem(record.error().reason);
      if (!record->has_value()) break;
      const RawRecord& raw = **record;
      if (group != raw.opcode) {
        if (group) ended_groups.insert(*group);
        if (ended_groups.count(raw.opcode) != 0) {
          findings_.problem_at(raw.offset, "the records of the summary are not grouped by kind");
        }
        group = raw.opcode;
      }
      if (raw.opcode == Opcode::kSummaryOffset) {
        if (footer.summary_offset_start == 0 || raw.offset < footer.summary_offset_start) {
          findings_.problem_at(raw.offset, "the footer gives another place of the summary offsets");
        }
      } else {
        SummaryOffset& extent = groups_[raw.opcode];
        if (extent.group_length == 0) extent.group_start = raw.offset;
        extent.group_opcode = raw.opcode;
        extent.group_length = raw.end() - extent.group_start;
      }
      check_summary_record(stream, raw);
    }
  }

 private:
  void check_summary_record(const RecordStream& stream, const RawRecord& raw) {
    switch (raw.opcode) {
      case Opcode::kSchema:
        if (const auto schema = findings_.decoded<Schema>(stream, raw))
          repeat(raw, *schema, contents_.schemas);
        return;
      case Opcode::kChannel:
        if (const auto channel = findings_.decoded<Channel>(stream, raw))
          repeat(raw, *channel, contents_.channels);
        return;
      case Opcode::kStatistics:
        if (const auto statistics = findings_.decoded<Statistics>(stream, raw))
          check(raw, *statistics);
        return;
      case Opcode::kChunkIndex:
        if (const auto index = findings_.decoded<ChunkIndex>(stream, raw)) {
          compare(raw, *index, index->chunk_start_offset, contents_.chunks);
        }
        return;
      case Opcode::kAttachmentIndex:
        if (const auto index = findings_.decoded<AttachmentIndex>(stream, raw)) {
          compare(raw, *index, index->offset, contents_.attachments);
        }
        return;
      case Opcode::kMetadataIndex:
        if (const auto index = findings_.decoded<MetadataIndex>(stream, raw)) {
          compare(raw, *index, index->offset, contents_.metadata);
        }
        return;
      case Opcode::kSummaryOffset:
        if (const auto offset = findings_.decoded<SummaryOffset>(stream, raw)) check(raw, *offset);
        return;
      default:
        findings_.foreign_record(raw, "summary");
    }
  }

  template <class Record>
  void repeat(const RawRecord& raw, const Record& record,
              const std::map<std::uint16_t, Record>& originals) {
    const auto original = originals.find(record.id);
    if (original != originals.end() && original->second == record) return;
    if (original == originals.end() && contents_.lost_messages)
      return;  // it was in a damaged chunk
    findings_.problem_at(raw.offset, std::string(name_of(raw.opcode)) + " " +
                                         std::to_string(record.id) +
                                         " of the summary is not that of the data");
  }

  void check(const RawRecord& raw, const Statistics& given) {
    const Statistics& counted = counted_;
    if (contents_.lost_messages) return;  // they cannot be counted any more
    const bool counts_agree = given.message_count == counted.message_count &&
                              given.schema_count == counted.schema_count &&
                              given.channel_count == counted.channel_count &&
                              given.attachment_count == counted.attachment_count &&
                              given.metadata_count == counted.metadata_count &&
                              given.chunk_count == counted.chunk_count;
    if (given.message_start_time != counted.message_start_time ||
        given.message_end_time != counted.message_end_time) {
      // Writers are about that take a log time of 0 for "not set".
      findings_.remark_at(raw.offset, "the statistics give other times than the messages have");
    }
    auto given_counts = given.channel_message_counts;  // a channel without messages may be listed
    for (auto it = given_counts.begin(); it != given_counts.end();) {
      it = it->second == 0 ? given_counts.erase(it) : std::next(it);
    }
    if (!counts_agree ||
        (!given_counts.empty() && given_counts != counted.channel_message_counts)) {
      findings_.problem_at(raw.offset, "the statistics are not those of the data");
    }
  }

  template <class Index>
  void compare(const RawRecord& raw, const Index& index, std::uint64_t offset,
               const std::map<std::uint64_t, Index>& actual) {
    const auto found = actual.find(offset);
    if (found == actual.end() && contents_.lost_messages) return;
    if (found == actual.end() || !same(index, found->second)) {
      findings_.problem_at(raw.offset, std::string("a ") + name_of(raw.opcode) +
                                           " record names byte " + std::to_string(offset) +
                                           ", where something else stands");
    } else if (!indexes_agree(index, found->second)) {
      findings_.problem_at(raw.offset, "a chunk index gives wrong places of the message indexes");
    }
  }

  template <class Index>
  static bool indexes_agree(const Index&, const Index&) {
    return true;
  }
  static bool indexes_agree(const ChunkIndex& given, const ChunkIndex& actual) {
    return given.message_index_offsets.empty() ||
           (given.message_index_offsets == actual.message_index_offsets &&
            given.message_index_length == actual.message_index_length);
  }

  void check(const RawRecord& raw, const SummaryOffset& offset) {
    const auto group = groups_.find(offset.group_opcode);
    const bool agrees = group == groups_.end()
                            ? offset.group_length == 0
                            : group->second.group_start == offset.group_start &&
                                  group->second.group_length == offset.group_length;
    if (!agrees) findings_.problem_at(raw.offset, "a summary offset names a wrong place");
  }

  Findings& findings_;
  const Contents& contents_;
  const Statistics& counted_;
  std::map<Opcode, SummaryOffset> groups_;
};

}  // namespace

void verify_summary(RecordStream& stream, const Footer& footer, std::uint64_t footer_offset,
                    Findings& findings, const Contents& contents) {
  SummaryVerifier(findings, contents).run(stream, footer, footer_offset);
}

}  // namespace swiftlet::mcap
