// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

#include "components/bag/recording_records.hpp"
#include "components/bag/recording_state.hpp"

namespace swiftlet {

mcap::Timestamp begin_of(const mcap::Reader& file) {
  mcap::Timestamp begin = file.statistics().message_start_time;
  for (const mcap::ChunkIndex& chunk : file.chunks()) {
    if (chunk.message_start_time > 0) begin = std::min(begin, chunk.message_start_time);
  }
  return begin;
}

std::optional<mcap::Metadata> last_metadata(const mcap::Reader& file, const std::string& name) {
  std::optional<mcap::Metadata> last;
  for (const mcap::MetadataIndex& index : file.metadata()) {
    if (index.name != name) continue;
    auto read = file.read(index);
    if (read.ok()) last = std::move(*read);
  }
  return last;
}

std::optional<LossLedger> losses_of(const Recording& recording) {
  std::optional<LossLedger> sum;
  for (const mcap::Reader& file : recording.files()) {
    const auto record = last_metadata(file, kLossRecord);
    const auto ledger = record ? ledger_of(*record) : std::nullopt;
    if (!ledger) continue;
    if (!sum) sum.emplace();
    add(*sum, *ledger);
  }
  return sum;
}

std::optional<mcap::Metadata> metadata_named(const Recording& recording, const std::string& name) {
  for (const mcap::Reader& file : recording.files()) {
    if (auto found = last_metadata(file, name)) return found;
  }
  return std::nullopt;
}

std::vector<std::string> missing_parts(const Recording& recording) {
  std::set<unsigned long> parts;
  for (const mcap::Reader& file : recording.files()) {
    const auto record = last_metadata(file, kPartRecord);
    if (!record) continue;
    const auto number = record->metadata.find("part");
    if (number == record->metadata.end()) continue;
    parts.insert(std::strtoul(number->second.c_str(), nullptr, 10));
  }
  std::vector<std::string> missing;
  unsigned long expected = 0;
  for (const unsigned long part : parts) {
    if (part > expected) {
      missing.push_back(recording.name() + ": of the recording's parts, " +
                        (part == expected + 1 ? "part " + std::to_string(expected) + " is missing"
                                              : "parts " + std::to_string(expected) + " to " +
                                                    std::to_string(part - 1) + " are missing"));
    }
    expected = part + 1;
  }
  return missing;
}

}  // namespace swiftlet
