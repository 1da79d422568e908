// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/writer.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "components/bag/mcap/verify.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

using testing::HasSubstr;

std::vector<std::string> problems_of(const std::filesystem::path& path) {
  const auto source = open_file(path);
  EXPECT_TRUE(source.ok());
  const auto found = verify(*source);
  EXPECT_TRUE(found.ok());
  return found->problems;
}

TEST(McapWriter, WhatIsWrittenIsReadWithEveryCompressionAndChunkSize) {
  const TemporaryFolder folder;
  const auto samples = random_samples(1, 2000, 5000);
  for (const Compression compression :
       {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    for (const std::uint64_t chunk_size : {1ULL, 3000ULL, 1ULL << 20}) {
      WriterParams params;
      params.compression = compression;
      params.chunk_size = chunk_size;
      write_samples(folder / "f.mcap", samples, params);
      const auto reader = Reader::open(folder / "f.mcap");
      ASSERT_TRUE(reader.ok()) << reader.error().reason;
      EXPECT_TRUE(reader->indexed());
      EXPECT_EQ(read_samples(*reader), by_time(samples));
      EXPECT_THAT(problems_of(folder / "f.mcap"), testing::IsEmpty());
    }
  }
}

TEST(McapWriter, ChunksKeepTheirSizeAndTime) {
  const TemporaryFolder folder;
  const auto samples = random_samples(2, 3000, 0);
  WriterParams params;
  params.chunk_size = 10'000;
  params.chunk_duration = Duration(100'000);
  write_samples(folder / "f.mcap", samples, params);
  const auto reader = Reader::open(folder / "f.mcap");
  ASSERT_TRUE(reader.ok());
  ASSERT_GT(reader->chunks().size(), 10U);
  for (const ChunkIndex& chunk : reader->chunks()) {
    EXPECT_LT(chunk.uncompressed_size, 10'000U + 300U);
    EXPECT_LT(chunk.message_end_time - chunk.message_start_time, 100'000U);
  }
}

TEST(McapWriter, CompressesWhatCanBeCompressedAndOnlyThat) {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  for (const bool noise : {false, true}) {
    std::vector<Sample> samples(50);
    for (Sample& sample : samples) {
      sample = {"a", 0, 5, 5, Bytes(5000, 1)};
      if (noise) {
        for (auto& byte : sample.data) byte = static_cast<std::uint8_t>(random());
      }
    }
    write_samples(folder / "f.mcap", samples, {});
    const auto reader = Reader::open(folder / "f.mcap");
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(reader->chunks()[0].compression, noise ? "" : "zstd");
    EXPECT_EQ(reader->size() < 20'000, !noise);
    EXPECT_EQ(read_samples(*reader), samples);
  }
}

TEST(McapWriter, CompressionChangesFromTheOpenChunkOn) {
  const TemporaryFolder folder;
  auto writer = Writer::open(folder / "f.mcap");
  ASSERT_TRUE(writer.ok());
  const auto channel = writer->add_channel("t", "cdr", 0);
  const Bytes zeros(10'000);
  for (const Compression compression :
       {Compression::kZstd, Compression::kNone, Compression::kLz4}) {
    ASSERT_TRUE(writer->write(Message{*channel, 0, 1, 1, zeros}).ok());
    writer->set_compression(compression);
    ASSERT_TRUE(writer->flush().ok());
  }
  ASSERT_TRUE(writer->close().ok());
  const auto reader = Reader::open(folder / "f.mcap");
  ASSERT_TRUE(reader.ok());
  ASSERT_EQ(reader->chunks().size(), 3U);
  EXPECT_EQ(reader->chunks()[0].compression, "zstd");
  EXPECT_EQ(reader->chunks()[1].compression, "");
  EXPECT_EQ(reader->chunks()[2].compression, "lz4");
  EXPECT_EQ(read_samples(*reader).size(), 3U);
}

TEST(McapWriter, TheSameCallsMakeTheSameBytes) {
  const TemporaryFolder folder;
  const auto samples = random_samples(4, 500, 3000);
  write_samples(folder / "one.mcap", samples, {});
  write_samples(folder / "two.mcap", samples, {});
  EXPECT_EQ(read_bytes(folder / "one.mcap"), read_bytes(folder / "two.mcap"));
}

TEST(McapWriter, EqualSchemasAreOne) {
  const TemporaryFolder folder;
  auto writer = Writer::open(folder / "f.mcap");
  ASSERT_TRUE(writer.ok());
  const auto one = writer->add_schema("a/msg/A", "ros2idl", std::string_view("x"));
  const auto same = writer->add_schema("a/msg/A", "ros2idl", std::string_view("x"));
  const auto other = writer->add_schema("a/msg/A", "ros2idl", std::string_view("y"));
  EXPECT_EQ(*one, *same);
  EXPECT_NE(*one, *other);
}

TEST(McapWriter, RefusesWhatWouldMakeAFileThatCannotBeRead) {
  const TemporaryFolder folder;
  auto writer = Writer::open(folder / "f.mcap");
  ASSERT_TRUE(writer.ok());
  EXPECT_FALSE(writer->add_channel("t", "cdr", 1).ok());
  EXPECT_FALSE(writer->write(Message{1, 0, 0, 0, {}}).ok());
  EXPECT_FALSE(writer->write(Message{0, 0, 0, 0, {}}).ok());
  ASSERT_TRUE(writer->close().ok());
  EXPECT_FALSE(writer->write(Metadata{"late", {}}).ok());
  EXPECT_THAT(problems_of(folder / "f.mcap"), testing::IsEmpty());
}

TEST(McapWriter, DoesNotReplaceAFileUnlessTold) {
  const TemporaryFolder folder;
  write_samples(folder / "f.mcap", random_samples(5, 10, 0), {});
  const Bytes before = read_bytes(folder / "f.mcap");
  const auto refused = Writer::open(folder / "f.mcap");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, HasSubstr("exists already"));
  EXPECT_EQ(read_bytes(folder / "f.mcap"), before);
}

TEST(McapWriter, SaysWhereAFileCannotBeMade) {
  const auto writer = Writer::open("/proc/nowhere/f.mcap");
  ASSERT_FALSE(writer.ok());
  EXPECT_THAT(writer.error().reason, HasSubstr("/proc/nowhere/f.mcap"));
}

/// A full disk, made by a limit of the file size in a child process.
TEST(McapWriter, AFullDiskIsReportedAndWhatIsOnItStaysReadable) {
  const TemporaryFolder folder;
  const auto path = folder / "f.mcap";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20'000, 20'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    WriterParams params;
    params.compression = Compression::kNone;
    params.chunk_size = 3000;
    auto writer = Writer::open(path, params);
    const auto channel = writer->add_channel("a", "cdr", 0);
    Status done;
    for (int i = 0; i < 1000 && done.ok(); ++i) {
      done = writer->write(Message{*channel, 0, 1, 1, Bytes(100, 7)});
    }
    const bool reported = !done.ok() && done.error().reason.find("f.mcap") != std::string::npos &&
                          done.error().reason.find("cannot be written") != std::string::npos;
    const bool stays_reported = !writer->flush().ok() && !writer->close().ok();
    ::_exit(reported && stays_reported ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  const auto reader = Reader::open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().reason;
  EXPECT_GT(read_samples(*reader).size(), 100U);
  // Cut back to the last whole chunk: only the footer is missing.
  EXPECT_EQ(reader->damage().size(), 1U);
}

TEST(McapWriter, AKilledProcessLeavesAllButItsLastChunk) {
  const TemporaryFolder folder;
  const auto path = folder / "f.mcap";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto writer = Writer::open(path);
    const auto channel = writer->add_channel("a", "cdr", 0);
    for (std::uint32_t i = 0; i < 1050; ++i) {  // 10.5 s at 100 Hz
      (void)writer->write(Message{*channel, i, i * 10'000'000ULL, 0, Bytes(20, 7)});
    }
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto reader = Reader::open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().reason;
  EXPECT_FALSE(reader->finished());
  ASSERT_EQ(reader->damage().size(), 1U);
  EXPECT_THAT(reader->damage()[0].reason, HasSubstr("not closed"));
  const auto samples = read_samples(*reader);
  EXPECT_EQ(samples.size(), 1000U);  // the last second was still in memory
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].sequence, i);
}

TEST(McapWriter, FlushPutsEverythingIntoTheFile) {
  const TemporaryFolder folder;
  auto writer = Writer::open(folder / "f.mcap");
  const auto channel = writer->add_channel("a", "cdr", 0);
  ASSERT_TRUE(writer->write(Message{*channel, 3, 4, 5, Bytes(20, 7)}).ok());
  EXPECT_EQ(Reader::open(folder / "f.mcap")->statistics().message_count, 0U);
  ASSERT_TRUE(writer->flush().ok());
  EXPECT_EQ(Reader::open(folder / "f.mcap")->statistics().message_count, 1U);
}

TEST(McapTime, ConversionsSaturate) {
  EXPECT_EQ(to_timestamp(Time(Duration(-5))), 0U);
  EXPECT_EQ(to_timestamp(Time(Duration(5))), 5U);
  EXPECT_EQ(to_time(~Timestamp{0}), Time::max());
  EXPECT_EQ(to_time(to_timestamp(Time(Duration(1234567890123456789)))),
            Time(Duration(1234567890123456789)));
}

}  // namespace
}  // namespace swiftlet::mcap
