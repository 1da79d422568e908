// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/verify.hpp"

#include <gmock/gmock.h>

#include "components/bag/mcap/record_codec.hpp"
#include "components/bag/mcap/record_stream.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr std::size_t kTrailer = 4 + sizeof(kMagic);  // checksum of the summary, magic

void put(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// A file whose records were changed by somebody who then put all checksums right, so that only
/// a look at the meaning finds the lie.
class Forger {
 public:
  explicit Forger(Bytes bytes) : bytes_(std::move(bytes)) {}

  /// Lets `change` edit the record number `index` of its kind; its size must stay.
  template <class Record, class Change>
  void forge(Opcode opcode, std::size_t index, Change&& change) {
    const RawRecord raw = find(opcode, index);
    Record record;
    ASSERT_TRUE(decode(content_of(bytes_, raw), record));
    const Bytes keep = content_of(bytes_, raw).copy();  // a chunk's records point into it
    ASSERT_TRUE(decode(keep, record));
    change(record);
    Bytes made;
    append(made, record);
    ASSERT_EQ(made.size(), raw.end() - raw.offset);
    std::copy(made.begin(), made.end(), bytes_.begin() + static_cast<long>(raw.offset));
  }

  std::vector<std::string> problems() {
    const RawRecord end = find(Opcode::kDataEnd, 0);
    put(bytes_, end.offset + kRecordPrefixSize, crc32(ByteView(bytes_).part(0, end.offset)));
    const ByteView all(bytes_);
    put(bytes_, bytes_.size() - kTrailer,
        crc32(all.part(end.end(), bytes_.size() - kTrailer - end.end())));
    const auto found = verify(from_memory(bytes_, "forged.mcap"));
    return found->problems;
  }

 private:
  RawRecord find(Opcode opcode, std::size_t index) const {
    std::uint64_t position = sizeof(kMagic);
    RawRecord record;
    while (next_record(bytes_, position, record)) {
      if (record.opcode == opcode && index-- == 0) return record;
    }
    ADD_FAILURE() << "no such record";
    return record;
  }

  Bytes bytes_;
};

class McapVerify : public testing::Test {
 protected:
  Forger forger() const {
    const TemporaryFolder folder;
    WriterParams params;
    params.chunk_size = 4000;
    params.compression = Compression::kNone;
    write_samples(folder / "f.mcap", random_samples(4, 300, 1000), params);
    return Forger(read_bytes(folder / "f.mcap"));
  }
};

TEST_F(McapVerify, ChecksumsThatWerePutRightHideNothingWhereNothingIsWrong) {
  EXPECT_THAT(forger().problems(), testing::IsEmpty());
}

TEST_F(McapVerify, WrongStatistics) {
  const auto check = [&](auto change) {
    Forger f = forger();
    f.forge<Statistics>(Opcode::kStatistics, 0, change);
    EXPECT_THAT(f.problems(), testing::ElementsAre(HasSubstr("statistics are not those")));
  };
  check([](Statistics& s) { ++s.message_count; });
  check([](Statistics& s) { ++s.schema_count; });
  check([](Statistics& s) { --s.channel_count; });
  check([](Statistics& s) { --s.chunk_count; });
  check([](Statistics& s) { ++s.attachment_count; });
  check([](Statistics& s) { --s.metadata_count; });
  check([](Statistics& s) { ++s.channel_message_counts[2]; });
}

TEST_F(McapVerify, WrongChunkIndexes) {
  const auto check = [&](const char* problem, auto change) {
    Forger f = forger();
    f.forge<ChunkIndex>(Opcode::kChunkIndex, 1, change);
    EXPECT_THAT(f.problems(), testing::ElementsAre(HasSubstr(problem)));
  };
  check("something else stands", [](ChunkIndex& c) { ++c.chunk_start_offset; });
  check("something else stands", [](ChunkIndex& c) { --c.chunk_length; });
  check("something else stands", [](ChunkIndex& c) { --c.message_end_time; });
  check("something else stands", [](ChunkIndex& c) { ++c.message_start_time; });
  check("something else stands", [](ChunkIndex& c) { ++c.uncompressed_size; });
  check("something else stands", [](ChunkIndex& c) { ++c.compressed_size; });
  check("wrong places of the message indexes", [](ChunkIndex& c) { ++c.message_index_length; });
  check("wrong places of the message indexes",
        [](ChunkIndex& c) { ++c.message_index_offsets.begin()->second; });
}

TEST_F(McapVerify, WrongMessageIndexes) {
  for (const bool time : {true, false}) {
    Forger f = forger();
    f.forge<MessageIndex>(Opcode::kMessageIndex, 2, [time](MessageIndex& index) {
      ++(time ? index.records[1].first : index.records[1].second);
    });
    EXPECT_THAT(f.problems(), testing::ElementsAre(HasSubstr("does not name the messages")));
  }
  Forger f = forger();
  f.forge<MessageIndex>(Opcode::kMessageIndex, 0,
                        [](MessageIndex& index) { index.channel_id = 9; });
  EXPECT_THAT(f.problems(), Contains(HasSubstr("no index of them")));
}

TEST_F(McapVerify, WrongChunkTimes) {
  Forger f = forger();
  f.forge<Chunk>(Opcode::kChunk, 1, [](Chunk& chunk) { chunk.message_start_time -= 1; });
  EXPECT_THAT(f.problems(), testing::ElementsAre(HasSubstr("other times than its messages")));
}

TEST_F(McapVerify, DefinitionsInTheSummaryMustBeThoseOfTheData) {
  Forger channel = forger();
  channel.forge<Channel>(Opcode::kChannel, 0, [](Channel& c) { c.topic = "z"; });
  EXPECT_THAT(channel.problems(), testing::ElementsAre(HasSubstr("Channel 1 of the summary")));
  Forger schema = forger();
  schema.forge<Schema>(Opcode::kSchema, 0, [](Schema& s) { s.data[0] ^= 1; });
  EXPECT_THAT(schema.problems(), testing::ElementsAre(HasSubstr("Schema 1 of the summary")));
}

TEST_F(McapVerify, WrongPlacesOfAttachmentsMetadataAndGroups) {
  Forger attachment = forger();
  attachment.forge<AttachmentIndex>(Opcode::kAttachmentIndex, 0,
                                    [](AttachmentIndex& a) { ++a.data_size; });
  EXPECT_THAT(attachment.problems(), testing::ElementsAre(HasSubstr("AttachmentIndex")));
  Forger metadata = forger();
  metadata.forge<MetadataIndex>(Opcode::kMetadataIndex, 0, [](MetadataIndex& m) { --m.offset; });
  EXPECT_THAT(metadata.problems(), testing::ElementsAre(HasSubstr("MetadataIndex")));
  Forger group = forger();
  group.forge<SummaryOffset>(Opcode::kSummaryOffset, 1, [](SummaryOffset& o) { ++o.group_start; });
  EXPECT_THAT(group.problems(), testing::ElementsAre(HasSubstr("summary offset")));
  Forger footer = forger();
  footer.forge<Footer>(Opcode::kFooter, 0, [](Footer& f) { f.summary_start += 1; });
  EXPECT_THAT(footer.problems(), Contains(HasSubstr("another place of the summary")));
}

TEST_F(McapVerify, MessagesOfAChannelThatNothingDescribes) {
  Bytes bytes(kMagic, kMagic + sizeof(kMagic));
  append(bytes, Header{});
  append(bytes, Channel{1, 5, "t", "cdr", {}});
  append(bytes, Message{2, 0, 0, 0, {}});
  append(bytes, DataEnd{});
  append(bytes, Footer{});
  bytes.insert(bytes.end(), kMagic, kMagic + sizeof(kMagic));
  const auto source = from_memory(bytes, "f.mcap");
  EXPECT_THAT(verify(source)->problems,
              testing::ElementsAre(HasSubstr("names schema 5"), HasSubstr("channel 2")));
  const auto reader = Reader::open(source);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader->damage().size(), 1U);
  EXPECT_TRUE(read_samples(*reader).empty());
}

}  // namespace
}  // namespace swiftlet::mcap
