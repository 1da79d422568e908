// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "components/bag/mcap/verify.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

constexpr int kMutations = 1500;  // of each file

struct Outcome {
  bool opened = false;
  std::uint64_t messages = 0;
  std::uint64_t errors = 0;
  bool found_unsound = false;
};

/// Does everything that can be done with a file. Must end, whatever the bytes are.
Outcome use_everything(const Bytes& bytes, std::size_t chunk_bound) {
  Outcome outcome;
  const auto source = from_memory(bytes, "mutant.mcap");
  const auto found = verify(source);
  outcome.found_unsound = !found.ok() || !found->problems.empty();
  for (const bool use_index : {true, false}) {
    ReaderParams params;
    params.use_index = use_index;
    const auto reader = Reader::open(source, params);
    if (!reader.ok()) {
      ++outcome.errors;
      EXPECT_NE(reader.error().reason.find("mutant.mcap"), std::string::npos);
      continue;
    }
    outcome.opened = true;
    outcome.errors += reader->damage().size();
    for (const auto& index : reader->attachments()) (void)reader->read(index);
    for (const auto& index : reader->metadata()) (void)reader->read(index);
    MessageCursor cursor = reader->messages();
    Timestamp last = 0;
    // Every call gives a message or uses up a chunk, so that the loop is bounded.
    std::size_t calls = 0;
    for (auto next = cursor.next(); !next.ok() || next->has_value(); next = cursor.next()) {
      EXPECT_LT(++calls, chunk_bound + bytes.size());
      if (!next.ok()) {
        ++outcome.errors;
        continue;
      }
      EXPECT_GE((*next)->message.log_time, last);
      last = (*next)->message.log_time;
      EXPECT_NE((*next)->channel, nullptr);
      ++outcome.messages;
    }
  }
  return outcome;
}

class McapDamage : public testing::TestWithParam<Compression> {
 protected:
  Bytes make(bool close) const {
    const TemporaryFolder folder;
    WriterParams params;
    params.compression = GetParam();
    params.chunk_size = 2000;
    write_samples(folder / "f.mcap", random_samples(21, 120, 3000), params, close);
    return read_bytes(folder / "f.mcap");
  }
};

TEST_P(McapDamage, FlippedBytesNeverCrashAndNeverGoUnseen) {
  const Bytes sound = make(true);
  ASSERT_FALSE(use_everything(sound, 100).found_unsound);
  std::mt19937 random(31);
  for (int i = 0; i < kMutations; ++i) {
    Bytes mutant = sound;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int flip = 0; flip < flips; ++flip) {
      mutant[random() % mutant.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    }
    if (mutant == sound) continue;  // two flips of one bit
    // Checksums cover the whole file, so that verify sees every change.
    EXPECT_TRUE(use_everything(mutant, 1000).found_unsound) << "mutation " << i;
  }
}

/// Numbers that break arithmetic, where lengths and offsets stand.
TEST_P(McapDamage, HostileNumbersNeverCrash) {
  const Bytes sound = make(true);
  std::mt19937 random(32);
  const std::uint64_t numbers[] = {0,      1,          0x7f,         0xff,
                                   0xffff, 0x7fffffff, 0xffffffff,   0x7fffffffffffffff,
                                   ~0ULL,  ~0ULL - 8,  sound.size(), sound.size() - 1};
  for (int i = 0; i < kMutations; ++i) {
    Bytes mutant = sound;
    const std::size_t at = random() % (mutant.size() - 8);
    const std::uint64_t number = numbers[random() % std::size(numbers)];
    const std::size_t width = std::size_t{1} << (random() % 4);
    for (std::size_t byte = 0; byte < width; ++byte) {
      mutant[at + byte] = static_cast<std::uint8_t>(number >> (8 * byte));
    }
    const Outcome outcome = use_everything(mutant, 1000);
    EXPECT_EQ(outcome.found_unsound, mutant != sound) << "mutation " << i;
  }
}

TEST_P(McapDamage, TruncationsAndInsertionsNeverCrash) {
  for (const bool close : {true, false}) {
    const Bytes sound = make(close);
    std::mt19937 random(33);
    for (int i = 0; i < kMutations / 2; ++i) {
      Bytes mutant = sound;
      const auto at = static_cast<std::ptrdiff_t>(random() % mutant.size());
      if (random() % 2 == 0) {
        mutant.resize(static_cast<std::size_t>(at));
      } else {
        mutant.insert(mutant.begin() + at, 1 + random() % 20, static_cast<std::uint8_t>(random()));
      }
      EXPECT_TRUE(use_everything(mutant, 1000).found_unsound);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, McapDamage,
                         testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd),
                         [](const auto& tested) {
                           const std::string name = name_of(tested.param);
                           return name.empty() ? std::string("none") : name;
                         });

}  // namespace
}  // namespace swiftlet::mcap
