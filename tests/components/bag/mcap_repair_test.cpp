// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Laws of a repair: its result is sound, has nothing that was not there, and all that can be had.
#include "components/bag/mcap/repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "components/bag/mcap/record_stream.hpp"
#include "components/bag/mcap/verify.hpp"
#include "components/bag/repair_file.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kRecord = "test_repair";

class McapRepair : public testing::TestWithParam<Compression> {
 protected:
  /// A file of about a dozen chunks.
  Bytes make(bool chunks = true) const {
    WriterParams params;
    params.compression = GetParam();
    params.chunk_size = 2000;
    params.chunks = chunks;
    write_samples(folder_ / "f.mcap", samples_, params);
    return read_bytes(folder_ / "f.mcap");
  }

  struct Outcome {
    Repair repair;
    std::vector<Sample> samples;
    Bytes bytes;
  };

  /// Nothing where nothing is of MCAP. Whatever comes must be sound, and repairing it must change
  /// nothing but the note that it was repaired.
  std::optional<Outcome> repaired(const Bytes& bytes) const {
    const auto source = from_memory(bytes, "mutant.mcap");
    const auto done = repair(*source, out_, kRecord);
    if (!done.ok()) {
      EXPECT_FALSE(std::filesystem::exists(out_)) << "a repair that failed left something behind";
      return std::nullopt;
    }
    Outcome outcome{*done, {}, read_bytes(out_)};
    const auto sound = from_memory(outcome.bytes, "repaired.mcap");
    EXPECT_THAT(verify(sound)->problems, IsEmpty());
    const auto reader = Reader::open(sound);
    EXPECT_TRUE(reader->indexed());
    outcome.samples = read_samples(*reader);
    EXPECT_EQ(outcome.samples.size(), outcome.repair.saved.message_count);
    return outcome;
  }

  /// By sequence number, which is unique among samples_.
  static std::map<std::uint32_t, Sample> by_number(const std::vector<Sample>& samples) {
    std::map<std::uint32_t, Sample> map;
    for (const Sample& sample : samples) map.emplace(sample.sequence, sample);
    EXPECT_EQ(map.size(), samples.size()) << "a message was saved twice";
    return map;
  }

  void expect_only_originals(const std::vector<Sample>& samples) const {
    for (const auto& [number, sample] : by_number(samples)) {
      ASSERT_LT(number, samples_.size());
      EXPECT_EQ(sample, samples_[number]);
    }
  }

  /// In and around each prefix of a record, at the beginning and the end of its content, and a
  /// hundred places between, in ascending order.
  static std::set<std::size_t> places_to_cut(const Bytes& whole) {
    std::set<std::size_t> places = {0, 1, 7, 8, 9, whole.size() - 8, whole.size() - 1};
    const auto source = from_memory(whole, "f.mcap");
    RecordStream stream(*source, 8, whole.size() - 8);
    for (auto record = stream.next(); record.ok() && *record; record = stream.next()) {
      for (const std::size_t step : {0U, 1U, 4U, 8U, 9U, 10U, 30U}) {
        places.insert(static_cast<std::size_t>((*record)->offset) + step);
      }
      places.insert(static_cast<std::size_t>((*record)->end()) - 1);
    }
    std::mt19937 random(7);
    for (int i = 0; i < 100; ++i) places.insert(random() % whole.size());
    places.erase(places.lower_bound(whole.size()), places.end());
    return places;
  }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_ / "out.mcap";
  std::vector<Sample> samples_ = random_samples(21, 120, 3000);
};

TEST_P(McapRepair, OfASoundFileKeepsEverything) {
  const auto outcome = repaired(make());
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->samples, by_time(samples_));
  EXPECT_THAT(outcome->repair.problems, IsEmpty());
  const auto reader = Reader::open(out_);
  EXPECT_EQ(reader->attachments().size(), 1U);
  ASSERT_EQ(reader->metadata().size(), 2U);
  EXPECT_EQ(reader->read(reader->metadata()[0])->metadata.at("pilot"), "nobody");
  EXPECT_EQ(reader->metadata()[1].name, kRecord);
  EXPECT_EQ(reader->channels().begin()->second.metadata.at("key"), "a");
}

TEST_P(McapRepair, OfACutFileSavesEveryWholeChunkWhereverItIsCut) {
  const Bytes whole = make();
  const auto reader = Reader::open(from_memory(whole, "f.mcap"));
  std::size_t saved_before = 0;
  for (const std::size_t size : places_to_cut(whole)) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const auto outcome = repaired(cut);
    // Magic, and a header of five fields.
    if (!outcome) {
      EXPECT_LT(size, 50U);
      continue;
    }
    std::size_t whole_chunks = 0;
    for (const ChunkIndex& chunk : reader->chunks()) {
      if (chunk.chunk_start_offset + chunk.chunk_length <= size) ++whole_chunks;
    }
    expect_only_originals(outcome->samples);
    EXPECT_GE(outcome->samples.size(), saved_before) << "cut at " << size;
    saved_before = outcome->samples.size();
    const std::size_t at_least = samples_.size() * whole_chunks / (reader->chunks().size() + 1);
    EXPECT_GE(outcome->samples.size(), at_least) << "cut at " << size;
    if (HasFailure()) return;
  }
  EXPECT_EQ(saved_before, samples_.size()) << "all chunks were there when only the end was cut";
}

TEST_P(McapRepair, OfMessagesOutsideOfChunksSavesThoseInFrontOfTheCut) {
  const Bytes whole = make(false);
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const std::size_t size = 200 + random() % (whole.size() - 200);
    const auto outcome =
        repaired(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    ASSERT_TRUE(outcome);
    auto saved = by_number(outcome->samples);
    std::uint32_t expected = 0;
    for (const auto& [number, sample] : saved) EXPECT_EQ(number, expected++) << "out of order";
    expect_only_originals(outcome->samples);
  }
}

TEST_P(McapRepair, OfAChangedByteLosesOneChunkAtMostAndSaysSo) {
  const Bytes sound = make();
  const auto reader = Reader::open(from_memory(sound, "f.mcap"));
  ASSERT_GT(reader->chunks().size(), 5U);
  std::size_t most = 0;
  for (const ChunkIndex& chunk : reader->chunks())
    most = std::max<std::size_t>(most, chunk.uncompressed_size);
  const std::uint64_t end_of_chunks = reader->chunks().back().chunk_start_offset;
  std::mt19937 random(5);
  for (int i = 0; i < 1500; ++i) {
    Bytes mutant = sound;
    const std::size_t at = random() % sound.size();
    mutant[at] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    const auto outcome = repaired(mutant);
    ASSERT_TRUE(outcome) << "byte " << at;
    expect_only_originals(outcome->samples);
    // A chunk of 2000 bytes has at most 2000 / 31 messages.
    EXPECT_GE(outcome->samples.size() + most / 31 + 1, samples_.size()) << "byte " << at;
    if (outcome->samples.size() < samples_.size()) {
      EXPECT_THAT(outcome->repair.problems, testing::Not(IsEmpty())) << "byte " << at;
      EXPECT_LT(at, end_of_chunks + 4000);
    }
    if (HasFailure()) return;
  }
}

TEST_P(McapRepair, OfManyChangesIsSoundAndHasNothingNew) {
  const Bytes sound = make();
  std::mt19937 random(6);
  for (int i = 0; i < 700; ++i) {
    Bytes mutant = sound;
    for (auto change = 1 + random() % 6; change-- > 0;) {
      const auto at = static_cast<std::ptrdiff_t>(random() % mutant.size());
      const auto count = static_cast<std::ptrdiff_t>(
          std::min<std::size_t>(1 + random() % 50, mutant.size() - static_cast<std::size_t>(at)));
      switch (random() % 4) {
        case 0:
          mutant[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1U << (random() % 8));
          break;
        case 1:
          mutant.erase(mutant.begin() + at, mutant.begin() + at + count);
          break;
        case 2:
          mutant.insert(mutant.begin() + at, static_cast<std::size_t>(count),
                        static_cast<std::uint8_t>(random()));
          break;
        default:
          std::fill(mutant.begin() + at, mutant.begin() + at + count,
                    static_cast<std::uint8_t>(random() % 2 == 0 ? 0 : 255));
      }
      if (mutant.empty()) mutant.push_back(0);
    }
    const auto outcome = repaired(mutant);
    if (outcome) expect_only_originals(outcome->samples);
    if (HasFailure()) return;
  }
}

TEST_P(McapRepair, WhatALostChunkHeldIsCountedByItsIndexes) {
  const Bytes sound = make();
  const auto reader = Reader::open(from_memory(sound, "f.mcap"));
  const ChunkIndex& chunk = reader->chunks()[3];
  Bytes mutant = sound;
  mutant[chunk.chunk_start_offset + chunk.chunk_length / 2] ^= 0x10;
  const auto outcome = repaired(mutant);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->repair.lost_chunks, 1U);
  EXPECT_EQ(outcome->repair.lost_messages + outcome->samples.size(), samples_.size());
  ASSERT_EQ(outcome->repair.problems.size(), 1U);
  EXPECT_THAT(
      outcome->repair.problems[0],
      testing::AllOf(HasSubstr("byte " + std::to_string(chunk.chunk_start_offset)),
                     HasSubstr("it held " + std::to_string(outcome->repair.lost_messages))));
}

TEST_P(McapRepair, TypesAndTopicsOfALostFirstChunkComeFromTheSummary) {
  const Bytes sound = make();
  const auto reader = Reader::open(from_memory(sound, "f.mcap"));
  const ChunkIndex& chunk = reader->chunks()[0];
  Bytes mutant = sound;
  mutant[chunk.chunk_start_offset + chunk.chunk_length / 2] ^= 0x10;
  const auto outcome = repaired(mutant);
  ASSERT_TRUE(outcome);
  EXPECT_GT(outcome->samples.size(), samples_.size() / 2);
  expect_only_originals(outcome->samples);
}

TEST_P(McapRepair, TheSameBytesGiveTheSameFile) {
  Bytes mutant = make();
  mutant.resize(mutant.size() * 2 / 3);
  EXPECT_EQ(repaired(mutant)->bytes, repaired(mutant)->bytes);
}

TEST_P(McapRepair, InPlaceKeepsTheDamagedFileAndASecondTimeNothingIsLeftToDo) {
  const std::filesystem::path file = folder_ / "f.mcap";
  Bytes cut = make();
  cut.resize(cut.size() / 2);
  std::filesystem::resize_file(file, cut.size());
  const auto first = repair_file(file, std::nullopt);
  ASSERT_TRUE(first.ok()) << first.error().reason;
  EXPECT_EQ(read_bytes(folder_ / "f.mcap.damaged"), cut);
  const auto source = open_file(file);
  EXPECT_THAT(verify(*source)->problems, IsEmpty());
  EXPECT_EQ(read_samples(*Reader::open(file)).size(), first->repair.saved.message_count);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.mcap.repairing"));

  // Another damaged file of that name is kept beside the first.
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 20);
  ASSERT_TRUE(repair_file(file, std::nullopt).ok());
  EXPECT_EQ(read_bytes(folder_ / "f.mcap.damaged"), cut);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f.mcap.damaged2"));
}

TEST_P(McapRepair, IntoAnotherFileLeavesTheDamagedOneAlone) {
  const std::filesystem::path file = folder_ / "f.mcap";
  Bytes cut = make();
  cut.resize(cut.size() / 2);
  std::filesystem::resize_file(file, cut.size());
  ASSERT_TRUE(repair_file(file, out_).ok());
  EXPECT_EQ(read_bytes(file), cut);
  EXPECT_FALSE(repair_file(file, out_).ok()) << "a file that exists was replaced";
}

TEST(McapRepairOfOtherFiles, IsRefused) {
  const TemporaryFolder folder;
  for (const std::string text : {"", "hello\n", "\x89MCAP0\r\n", "\x06\x06\x06\x06\x06\x06\x06"}) {
    const auto source = from_memory(Bytes(text.begin(), text.end()), "text.mcap");
    const auto done = repair(*source, folder / "out.mcap", kRecord);
    ASSERT_FALSE(done.ok());
    EXPECT_THAT(done.error().reason, HasSubstr("text.mcap: byte "));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.mcap"));
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, McapRepair,
                         testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd),
                         [](const auto& tested) {
                           const std::string name = name_of(tested.param);
                           return name.empty() ? std::string("none") : name;
                         });

}  // namespace
}  // namespace swiftlet::mcap
