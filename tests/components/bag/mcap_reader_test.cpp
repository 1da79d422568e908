// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/reader.hpp"

#include <gmock/gmock.h>

#include "components/bag/mcap/record_codec.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

using testing::HasSubstr;

class McapReader : public testing::Test {
 protected:
  void SetUp() override {
    WriterParams params;
    params.chunk_size = 4000;
    params.profile = "ros2";
    write_samples(path_, samples_, params);
  }

  /// Brute force, straight from the definition of the filter.
  std::vector<Sample> expected(const Filter& filter) const {
    std::vector<Sample> kept;
    for (const Sample& sample : by_time(samples_)) {
      const bool topic = filter.topics.empty() ||
                         std::count(filter.topics.begin(), filter.topics.end(), sample.topic) > 0;
      if (topic && sample.log_time >= filter.first && sample.log_time <= filter.last) {
        kept.push_back(sample);
      }
    }
    return kept;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "f.mcap";
  std::vector<Sample> samples_ = random_samples(11, 3000, 40'000);
};

TEST_F(McapReader, KnowsAllThatTheFileHolds) {
  for (const bool use_index : {true, false}) {
    ReaderParams params;
    params.use_index = use_index;
    const auto reader = Reader::open(path_, params);
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(reader->indexed(), use_index);
    EXPECT_TRUE(reader->finished());
    EXPECT_EQ(reader->header().profile, "ros2");
    ASSERT_EQ(reader->channels().size(), 3U);
    EXPECT_EQ(reader->channels().at(2).topic, "b");
    EXPECT_EQ(reader->channels().at(2).metadata.at("key"), "b");
    EXPECT_EQ(reader->schemas().at(1).name, "test/msg/Blob");
    EXPECT_EQ(reader->statistics().message_count, samples_.size());
    EXPECT_EQ(reader->statistics().message_start_time, by_time(samples_).front().log_time);
    EXPECT_EQ(reader->statistics().message_end_time, by_time(samples_).back().log_time);
    ASSERT_EQ(reader->attachments().size(), 1U);
    EXPECT_EQ(reader->read(reader->attachments()[0])->data, Bytes(1000, 42));
    ASSERT_EQ(reader->metadata().size(), 1U);
    EXPECT_EQ(reader->read(reader->metadata()[0])->metadata.at("pilot"), "nobody");
  }
}

TEST_F(McapReader, FiltersLikeBruteForce) {
  const Timestamp middle = 1'000'000 + 700'000;
  const std::vector<Filter> filters = {
      {},
      {{"b"}, 0, ~Timestamp{0}},
      {{"c", "a"}, middle, middle + 50'000},
      {{}, middle, middle},
      {{}, samples_[17].log_time, samples_[17].log_time},
      {{"nobody publishes this"}, 0, ~Timestamp{0}},
      {{}, middle, middle - 1},
  };
  for (const bool use_index : {true, false}) {
    ReaderParams params;
    params.use_index = use_index;
    const auto reader = Reader::open(path_, params);
    ASSERT_TRUE(reader.ok());
    for (const Filter& filter : filters) {
      EXPECT_EQ(read_samples(*reader, filter), expected(filter));
    }
  }
  EXPECT_FALSE(expected(filters[2]).empty());
  EXPECT_FALSE(expected(filters[4]).empty());
}

TEST_F(McapReader, MessagesOutsideOfChunksAreReadAndFilteredTheSameWay) {
  WriterParams writer_params;
  writer_params.chunks = false;
  write_samples(path_, samples_, writer_params);
  const auto reader = Reader::open(path_);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(read_samples(*reader), by_time(samples_));
  const Filter filter{{"b"}, 1'100'000, 1'900'000};
  EXPECT_EQ(read_samples(*reader, filter), expected(filter));
}

TEST_F(McapReader, ACursorOutlivesItsReader) {
  std::optional<MessageCursor> cursor;
  {
    const auto reader = Reader::open(path_);
    cursor.emplace(reader->messages());
  }
  const auto next = cursor->next();
  ASSERT_TRUE(next.ok() && next->has_value());
  EXPECT_EQ((*next)->schema->name, "test/msg/Blob");
}

TEST_F(McapReader, ADamagedChunkCostsOnlyItsOwnMessages) {
  const auto sound = Reader::open(path_);
  const ChunkIndex chunk = sound->chunks()[3];
  Bytes bytes = read_bytes(path_);
  bytes[chunk.chunk_start_offset + chunk.chunk_length / 2] ^= 0x10;
  for (const bool use_index : {true, false}) {
    ReaderParams params;
    params.use_index = use_index;
    const auto reader = Reader::open(from_memory(bytes, "broken.mcap"), params);
    ASSERT_TRUE(reader.ok()) << reader.error().reason;
    MessageCursor cursor = reader->messages();
    std::size_t read = 0;
    std::vector<std::string> errors;
    Timestamp last = 0;
    for (;;) {
      const auto next = cursor.next();
      if (!next.ok()) {
        errors.push_back(next.error().reason);
        continue;
      }
      if (!next->has_value()) break;
      EXPECT_GE((*next)->message.log_time, last);
      last = (*next)->message.log_time;
      ++read;
    }
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_THAT(errors[0],
                HasSubstr("broken.mcap: byte " + std::to_string(chunk.chunk_start_offset)));
    std::size_t in_chunk = 0;
    Bytes content;
    const ByteView view(bytes);
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      const RecordPrefix prefix = decode_prefix(view.part(offset, kRecordPrefixSize));
      MessageIndex index;
      ASSERT_TRUE(decode(view.part(offset + kRecordPrefixSize, prefix.length), index));
      in_chunk += index.records.size();
    }
    EXPECT_EQ(read + in_chunk, samples_.size());
  }
}

TEST_F(McapReader, ADamagedSummaryCostsNothing) {
  Bytes bytes = read_bytes(path_);
  bytes[bytes.size() - 60] ^= 0xff;
  const auto reader = Reader::open(from_memory(bytes, "broken.mcap"));
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE(reader->indexed());
  ASSERT_EQ(reader->damage().size(), 1U);
  EXPECT_THAT(reader->damage()[0].reason, HasSubstr("summary is damaged"));
  EXPECT_EQ(read_samples(*reader), by_time(samples_));
}

/// Cut anywhere, a file gives a prefix of what was written, and says that it was cut.
TEST_F(McapReader, ATruncatedFileGivesThePrefixThatIsWhole) {
  const Bytes bytes = read_bytes(path_);
  const auto sound = Reader::open(path_);
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const std::size_t size = 100 + random() % (bytes.size() - 101);
    const auto reader = Reader::open(
        from_memory(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(size)), "cut.mcap"));
    ASSERT_TRUE(reader.ok()) << reader.error().reason;
    EXPECT_FALSE(reader->finished());
    EXPECT_FALSE(reader->damage().empty());
    std::size_t whole_chunks = 0;
    for (const ChunkIndex& chunk : sound->chunks()) {
      whole_chunks += chunk.chunk_start_offset + chunk.chunk_length <= size ? 1 : 0;
    }
    ASSERT_EQ(reader->chunks().size(), whole_chunks);
    const auto read = read_samples(*reader);
    const std::vector<Sample> written(samples_.begin(),
                                      samples_.begin() + static_cast<long>(read.size()));
    EXPECT_EQ(read, by_time(written));
  }
}

TEST_F(McapReader, UnknownRecordsAndFieldsAreSkipped) {
  Bytes bytes = read_bytes(path_);
  const auto sound = Reader::open(path_);
  // A record of a later version between header and first chunk, in a file that lost its summary.
  bytes.resize(sound->chunks().back().chunk_start_offset);
  Bytes unknown = {0x80, 3, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3};
  const std::size_t data_start = 8 + 9 + 4 + 4 + 4 + 8;
  bytes.insert(bytes.begin() + data_start, unknown.begin(), unknown.end());
  const auto reader = Reader::open(from_memory(bytes, "later.mcap"));
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader->chunks().size(), sound->chunks().size() - 1);
}

TEST(McapReaderErrors, NameFilePlaceAndRemedy) {
  const auto missing = Reader::open("/nowhere/f.mcap");
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().reason, HasSubstr("/nowhere/f.mcap: cannot be opened"));
  const auto folder = Reader::open("/");
  ASSERT_FALSE(folder.ok());
  EXPECT_THAT(folder.error().reason, HasSubstr("is not a file"));
  for (const char* text : {"", "x", "\x89MCAP0\r", "this is a text file, not a recording"}) {
    const auto wrong = Reader::open(from_memory(ByteView(std::string_view(text)).copy(), "a.txt"));
    ASSERT_FALSE(wrong.ok());
    EXPECT_THAT(wrong.error().reason, HasSubstr("a.txt: byte 0: does not begin as MCAP files do"));
    EXPECT_THAT(wrong.error().reason, HasSubstr("Give a file"));
  }
  const auto headless = Reader::open(from_memory(Bytes(kMagic, kMagic + 8), "h.mcap"));
  ASSERT_FALSE(headless.ok());
  EXPECT_THAT(headless.error().reason, HasSubstr("h.mcap: byte 8"));
}

/// A file made to hurt: one chunk that claims to be huge, in several ways.
Bytes hostile_file(const std::string& compression, std::uint64_t claimed, ByteView records) {
  Bytes bytes(kMagic, kMagic + sizeof(kMagic));
  append(bytes, Header{});
  Chunk chunk;
  chunk.compression = compression;
  chunk.uncompressed_size = claimed;
  chunk.records = records;
  append(bytes, chunk);
  append(bytes, DataEnd{});
  append(bytes, Footer{});
  bytes.insert(bytes.end(), kMagic, kMagic + sizeof(kMagic));
  return bytes;
}

TEST(McapReaderErrors, SizesThatAFileClaimsAreNotBelieved) {
  Bytes small;
  ASSERT_TRUE(compress(Compression::kZstd, Bytes(100, 1), small).ok());
  Bytes bomb;
  ASSERT_TRUE(compress(Compression::kZstd, Bytes(64 << 20, 0), bomb).ok());
  ASSERT_LT(bomb.size(), 10'000U);
  Bytes lz4;
  ASSERT_TRUE(compress(Compression::kLz4, Bytes(100, 1), lz4).ok());
  const std::vector<std::pair<Bytes, std::string>> cases = {
      {hostile_file("zstd", ~0ULL, small), "are accepted"},
      {hostile_file("zstd", kMaxChunkSize, small), "decompresses to only 100 bytes"},
      {hostile_file("zstd", 50, small), "decompresses to more than 50 bytes"},
      {hostile_file("zstd", 1000, bomb), "decompresses to more than 1000 bytes"},
      {hostile_file("lz4", 99, lz4), "decompresses to more than 99 bytes"},
      {hostile_file("lz4", 101, lz4), "decompresses to only 100 bytes"},
      {hostile_file("lz4", 100, small), "does not decompress"},
      {hostile_file("", 101, Bytes(100)), "decompresses to only 100 bytes"},
      {hostile_file("rot13", 100, small), "none of zstd, lz4"},
      {hostile_file("zstd", 100, ByteView(small).part(0, small.size() - 3)), "not complete"},
  };
  for (const auto& [bytes, problem] : cases) {
    const auto reader = Reader::open(from_memory(bytes, "h.mcap"));
    ASSERT_TRUE(reader.ok());
    ASSERT_EQ(reader->damage().size(), 1U) << problem;
    EXPECT_THAT(reader->damage()[0].reason, HasSubstr("h.mcap: byte 25: chunk"));
    EXPECT_THAT(reader->damage()[0].reason, HasSubstr(problem));
  }
}

TEST(McapReaderErrors, ChunksThatOverlapWithoutEndDoNotFillTheMemory) {
  const TemporaryFolder folder;
  std::vector<Sample> samples;
  for (int i = 0; i < 200; ++i) {  // every chunk reaches from the first to the last moment
    samples.push_back(
        {"a", 0, static_cast<Timestamp>(i % 2 == 0 ? 1 : 1'000'000'000), 0, Bytes(1000, 0)});
  }
  WriterParams writer_params;
  writer_params.chunk_size = 1500;
  writer_params.chunk_duration = Duration::zero();
  write_samples(folder / "f.mcap", samples, writer_params);
  ReaderParams params;
  params.max_memory = 20'000;
  const auto reader = Reader::open(folder / "f.mcap", params);
  ASSERT_TRUE(reader.ok());
  MessageCursor cursor = reader->messages();
  std::size_t errors = 0;
  for (auto next = cursor.next(); !next.ok() || next->has_value(); next = cursor.next()) {
    if (next.ok()) continue;
    ++errors;
    EXPECT_THAT(next.error().reason, HasSubstr("overlap in time"));
  }
  EXPECT_GT(errors, 10U);
  EXPECT_EQ(read_samples(*Reader::open(folder / "f.mcap")).size(), 200U);
}

}  // namespace
}  // namespace swiftlet::mcap
