// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/writer.hpp"

namespace swiftlet::mcap {
namespace {

/// What a flight records: scans of 1000 beams at 10 Hz and IMU samples at 1200 Hz, 60 s of it.
struct Recording {
  std::vector<Bytes> payloads;
  std::vector<Message> messages;
  std::int64_t bytes = 0;
};

Recording flight() {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  Recording recording;
  const auto add = [&](std::uint16_t channel, Timestamp time, std::size_t numbers) {
    Bytes payload(numbers * sizeof(float));
    for (std::size_t i = 0; i < numbers; ++i) {
      const float range = 2.0F + std::sin(static_cast<float>(i) * 0.006F) + noise(random);
      std::memcpy(payload.data() + i * sizeof(float), &range, sizeof(float));
    }
    recording.bytes += static_cast<std::int64_t>(payload.size());
    recording.payloads.push_back(std::move(payload));
    recording.messages.push_back({channel, 0, time, time, {}});
  };
  for (Timestamp step = 0; step < 60 * 1200; ++step) {
    add(1, step * 833'333, 80);
    if (step % 120 == 0) add(2, step * 833'333, 1000);
  }
  for (std::size_t i = 0; i < recording.messages.size(); ++i) {
    recording.messages[i].data = recording.payloads[i];
  }
  return recording;
}

const Recording& recording() {
  static const Recording made = flight();
  return made;
}

std::filesystem::path file() {
  return std::filesystem::temp_directory_path() / "swiftlet_mcap_bench.mcap";
}

bool write_file(Compression compression) {
  WriterParams params;
  params.compression = compression;
  params.overwrite = true;
  auto writer = Writer::open(file(), params);
  if (!writer.ok()) return false;
  if (!writer->add_channel("imu0", "cdr", 0).ok()) return false;
  if (!writer->add_channel("scan", "cdr", 0).ok()) return false;
  for (const Message& message : recording().messages) {
    if (!writer->write(message).ok()) return false;
  }
  return writer->close().ok();
}

/// bytes_per_second counts payloads, before compression.
void finish(benchmark::State& state) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * recording().bytes);
  state.counters["file/payload"] = static_cast<double>(std::filesystem::file_size(file())) /
                                   static_cast<double>(recording().bytes);
  std::filesystem::remove(file());
}

void mcap_write(benchmark::State& state, Compression compression) {
  (void)recording();
  for (auto _ : state) {
    if (!write_file(compression)) state.SkipWithError("cannot write");
  }
  finish(state);
}

void mcap_read(benchmark::State& state, Compression compression) {
  if (!write_file(compression)) return state.SkipWithError("cannot write");
  for (auto _ : state) {
    const auto reader = Reader::open(file());
    if (!reader.ok()) return state.SkipWithError("cannot read");
    std::size_t count = 0;
    MessageCursor cursor = reader->messages();
    for (auto next = cursor.next(); next.ok() && next->has_value(); next = cursor.next()) ++count;
    if (count != recording().messages.size()) state.SkipWithError("messages are missing");
  }
  finish(state);
}

BENCHMARK_CAPTURE(mcap_write, zstd, Compression::kZstd)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mcap_write, lz4, Compression::kLz4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mcap_write, none, Compression::kNone)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mcap_read, zstd, Compression::kZstd)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mcap_read, lz4, Compression::kLz4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mcap_read, none, Compression::kNone)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swiftlet::mcap
