// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the recorder is made of, without middleware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <deque>
#include <future>
#include <random>

#include "components/bag/background_writer.hpp"
#include "components/bag/loss_ledger.hpp"
#include "components/bag/sample_window.hpp"
#include "components/bag/units.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

RecordedSample sample_of(std::size_t bytes, std::uint32_t sequence, mcap::Timestamp time = 0) {
  RecordedSample sample;
  sample.sequence = sequence;
  sample.log_time = time;
  sample.data.resize(bytes);
  return sample;
}

/// A disk that writes nothing until it is told to.
class SlowDisk {
 public:
  BackgroundWriter::Sink sink() {
    return [this](const RecordedSample& sample) {
      opened_.wait();
      written_.push_back(sample.sequence);
      return Status();
    };
  }
  void open() { open_.set_value(); }
  const std::vector<std::uint32_t>& written() const { return written_; }

 private:
  std::promise<void> open_;
  std::shared_future<void> opened_ = open_.get_future();
  std::vector<std::uint32_t> written_;
};

TEST(BackgroundWriter, WritesAllInOrderWithJobsBetween) {
  std::vector<std::string> done;
  BackgroundWriter writer(1'000'000, [&](const RecordedSample& sample) {
    done.push_back(std::to_string(sample.sequence));
    return Status();
  });
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(writer.offer(sample_of(10, i)));
  writer.post([&] {
    done.emplace_back("job");
    return Status();
  });
  writer.push(sample_of(10, 4));
  EXPECT_TRUE(writer.drain().ok());
  EXPECT_THAT(done, ElementsAre("0", "1", "2", "3", "job", "4"));
  EXPECT_EQ(writer.queued_bytes(), 0U);
}

TEST(BackgroundWriter, HoldsNoMoreThanItsBoundAndSaysWhatItRefuses) {
  SlowDisk disk;
  BackgroundWriter writer(1'000'000, disk.sink());
  std::vector<std::uint32_t> accepted;
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    if (writer.offer(sample_of(random() % 3000, i))) accepted.push_back(i);
    EXPECT_LE(writer.queued_bytes(), 1'000'000U);
  }
  EXPECT_LT(accepted.size(), 1000U);
  EXPECT_GT(accepted.size(), 400U);
  disk.open();
  EXPECT_TRUE(writer.drain().ok());
  EXPECT_EQ(disk.written(), accepted);
  EXPECT_TRUE(writer.offer(sample_of(3000, 0))) << "there is room again";
}

TEST(BackgroundWriter, KeepsRoomForSmallSamplesWhereLargeOnesFillIt) {
  SlowDisk disk;
  BackgroundWriter writer(10'000'000, disk.sink());
  while (writer.offer(sample_of(500'000, 0))) continue;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(writer.offer(sample_of(5000, 0)));
  disk.open();
}

TEST(BackgroundWriter, TakesASampleThatIsLargerThanItsBoundWhenItIsEmpty) {
  BackgroundWriter writer(1000, [](const RecordedSample&) { return Status(); });
  EXPECT_TRUE(writer.offer(sample_of(100'000, 0)));
  EXPECT_TRUE(writer.drain().ok());
}

TEST(BackgroundWriter, WaitsForRoomWhereNothingMayBeLost) {
  std::atomic<std::uint32_t> written{0};
  std::atomic<std::uint64_t> most{0};
  BackgroundWriter writer(20'000, [&](const RecordedSample&) {
    ++written;
    return Status();
  });
  for (std::uint32_t i = 0; i < 5000; ++i) {
    writer.push(sample_of(1000, i));
    most = std::max(most.load(), writer.queued_bytes());
  }
  EXPECT_TRUE(writer.drain().ok());
  EXPECT_EQ(written, 5000U);
  EXPECT_LE(most, 20'000U);
}

TEST(BackgroundWriter, AfterAnErrorDoesNothingMoreAndNobodyWaitsForEver) {
  int calls = 0;
  BackgroundWriter writer(10'000, [&](const RecordedSample&) -> Status {
    if (++calls == 3) return Error{"disk full"};
    return {};
  });
  for (std::uint32_t i = 0; i < 100; ++i) writer.push(sample_of(1000, i));
  const Status done = writer.drain();
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().reason, "disk full");
  EXPECT_EQ(writer.failure().error().reason, "disk full");
  EXPECT_EQ(calls, 3);
}

TEST(SequenceWatch, CountsWhatIsMissingBetweenSamplesOfEachWriter) {
  // Against a count of what was left out, by two writers whose samples mix.
  std::mt19937 random(1);
  SequenceWatch watch;
  std::array<std::uint64_t, 2> sequence = {0, 1000};
  std::uint64_t left_out = 0, missing = 0, pending[2] = {0, 0};
  bool begun[2] = {false, false};
  for (int i = 0; i < 5000; ++i) {
    const std::size_t writer = random() % 2;
    ++sequence[writer];
    if (random() % 4 == 0) {
      pending[writer] += begun[writer] ? 1 : 0;
      continue;
    }
    begun[writer] = true;
    left_out += pending[writer];
    pending[writer] = 0;
    SequenceWatch::WriterId id{};
    id[15] = static_cast<std::uint8_t>(writer);
    missing += watch.missing_before(id, sequence[writer]);
  }
  EXPECT_GT(left_out, 500U);
  EXPECT_EQ(missing, left_out);
}

TEST(LossLedger, ComesBackFromItsRecord) {
  const LossLedger ledger = {{"a", {3, 0}}, {"b/c", {0, 7}}, {"d", {18446744073709551615U, 1}}};
  EXPECT_EQ(ledger_of(to_metadata(ledger, 5)), ledger);
  EXPECT_EQ(ledger_of(to_metadata({}, 5)), LossLedger());
  EXPECT_EQ(ledger_of({"other", {{"dds/a", "1"}}}), std::nullopt);
  EXPECT_EQ(ledger_of({kLossRecord, {{"dds/a", "1x"}}}), std::nullopt);
  EXPECT_EQ(ledger_of({kLossRecord, {{"dds/a", "-1"}}}), std::nullopt);
}

constexpr mcap::Timestamp kSecond = 1'000'000'000;

TEST(SampleWindow, HoldsTheSamplesOfTheLastMomentsAndTheLatchedOnesFromBefore) {
  SampleWindow window(10s, 100'000'000);
  RecordedSample map = sample_of(100, 7, 1 * kSecond);
  map.topic = 1;
  window.add(map, true);
  map.sequence = 8;
  map.writer[0] = 1;
  map.log_time = 2 * kSecond;
  window.add(map, true);
  for (std::uint32_t second = 3; second < 60; ++second) {
    window.add(sample_of(10, second, second * kSecond), false);
  }
  const auto content = window.content(59 * kSecond + kSecond / 2);
  ASSERT_EQ(content.samples.size(), 10U);
  EXPECT_EQ(content.samples.front()->sequence, 50U);
  EXPECT_EQ(content.begin, 50 * kSecond);
  ASSERT_EQ(content.latched.size(), 2U) << "the last of each writer";
  EXPECT_EQ(content.latched[0]->sequence, 7U);
  EXPECT_EQ(content.latched[1]->sequence, 8U);
  EXPECT_FALSE(window.is_cut_short());
  // Long silence: nothing but what stays true.
  EXPECT_EQ(window.content(500 * kSecond).samples.size(), 0U);
  EXPECT_EQ(window.content(500 * kSecond).latched.size(), 2U);
}

TEST(SampleWindow, TakesNoMoreMemoryThanItMay) {
  SampleWindow window(1000s, 1'000'000);
  std::mt19937 random(2);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    RecordedSample sample = sample_of(random() % 20'000, i, i * kSecond / 100);
    sample.topic = random() % 40;
    window.add(std::move(sample), sample.topic % 2 == 0);
    ASSERT_LE(window.bytes(), 750'000U);
  }
  EXPECT_TRUE(window.is_cut_short());
  const auto content = window.content(50 * kSecond);
  std::size_t latched = 0;
  for (const auto& sample : content.latched) latched += sample->memory();
  EXPECT_LE(latched, 250'000U);
  EXPECT_EQ(content.samples.back()->sequence, 4999U) << "the newest are those that count";
}

TEST(SampleWindow, WhatIsSavedStaysWhileTheWindowMovesOn) {
  SampleWindow window(10s, 100'000'000);
  for (std::uint32_t i = 0; i < 10; ++i) window.add(sample_of(10, i, i * kSecond), false);
  const auto content = window.content(9 * kSecond);
  for (std::uint32_t i = 100; i < 200; ++i) window.add(sample_of(10, i, i * kSecond), false);
  ASSERT_EQ(content.samples.size(), 10U);
  EXPECT_EQ(content.samples[9]->sequence, 9U);
}

TEST(SampleWindow, KnowsTheLossesOfItsTimeOnly) {
  SampleWindow window(10s, 1'000'000);
  LossLedger losses;
  for (std::uint32_t second = 0; second <= 30; ++second) {
    if (second == 5 || second == 25) losses["a"].by_dds += 4;
    window.note(losses, second * kSecond);
    window.add(sample_of(10, second, second * kSecond), false);
  }
  EXPECT_EQ(total(window.content(30 * kSecond).losses).by_dds, 4U);
}

TEST(Units, AreThoseThatPeopleWrite) {
  EXPECT_EQ(parse_size("-", "200MB"), 200'000'000U);
  EXPECT_EQ(parse_size("-", "1.5 GB"), 1'500'000'000U);
  EXPECT_EQ(parse_size("-", "64kib"), 65'536U);
  EXPECT_EQ(parse_size("-", "4096"), 4096U);
  EXPECT_EQ(parse_duration("-", "30s"), 30s);
  EXPECT_EQ(parse_duration("-", "500ms"), 500ms);
  EXPECT_EQ(parse_duration("-", "10min"), 10min);
  EXPECT_EQ(parse_duration("-", "2h"), 2h);
  EXPECT_EQ(parse_duration("-", "0.5"), 500ms);
  for (const char* wrong : {"", "MB", "-1", "0", "nan", "inf", "1e99", "1x", "1MBB", "1s", "0x"}) {
    EXPECT_THROW(parse_size("-", wrong), CLI::ValidationError) << wrong;
  }
  for (const char* wrong : {"", "s", "-1", "0", "nan", "inf", "1e99", "1x", "1MB", "s1"}) {
    EXPECT_THROW(parse_duration("-", wrong), CLI::ValidationError) << wrong;
  }
}

}  // namespace
}  // namespace swiftlet
