// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/loss_ledger.hpp"

#include <charconv>

namespace swiftlet {
namespace {

const std::string kByDds = "dds/";
const std::string kByRecorder = "recorder/";
/// Writers of one topic that are remembered. Those of a recording that lasts for days come and go.
constexpr std::size_t kMaxWriters = 1024;

std::optional<std::uint64_t> number(const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

Loss total(const LossLedger& ledger) {
  Loss sum;
  for (const auto& [topic, loss] : ledger) {
    sum.by_dds += loss.by_dds;
    sum.by_recorder += loss.by_recorder;
  }
  return sum;
}

void add(LossLedger& sum, const LossLedger& more) {
  for (const auto& [topic, loss] : more) {
    sum[topic].by_dds += loss.by_dds;
    sum[topic].by_recorder += loss.by_recorder;
  }
}

LossLedger since(const LossLedger& before, const LossLedger& now) {
  LossLedger difference;
  for (const auto& [topic, loss] : now) {
    const auto found = before.find(topic);
    const Loss known = found == before.end() ? Loss{} : found->second;
    const Loss more{loss.by_dds - known.by_dds, loss.by_recorder - known.by_recorder};
    if (more.total() > 0) difference[topic] = more;
  }
  return difference;
}

mcap::Metadata to_metadata(const LossLedger& ledger, mcap::Timestamp time) {
  mcap::Metadata record{kLossRecord, {{"time", std::to_string(time)}}};
  for (const auto& [topic, loss] : ledger) {
    if (loss.by_dds > 0) record.metadata[kByDds + topic] = std::to_string(loss.by_dds);
    if (loss.by_recorder > 0) {
      record.metadata[kByRecorder + topic] = std::to_string(loss.by_recorder);
    }
  }
  return record;
}

std::optional<LossLedger> ledger_of(const mcap::Metadata& metadata) {
  if (metadata.name != kLossRecord) return std::nullopt;
  LossLedger ledger;
  for (const auto& [key, value] : metadata.metadata) {
    const bool is_dds = key.compare(0, kByDds.size(), kByDds) == 0;
    const bool is_recorder = key.compare(0, kByRecorder.size(), kByRecorder) == 0;
    if (!is_dds && !is_recorder) continue;
    const auto count = number(value);
    if (!count) return std::nullopt;
    if (is_dds) ledger[key.substr(kByDds.size())].by_dds = *count;
    if (is_recorder) ledger[key.substr(kByRecorder.size())].by_recorder = *count;
  }
  return ledger;
}

bool SequenceWatch::is_new(const WriterId& writer, std::uint64_t sequence) const {
  const auto last = last_.find(writer);
  return last == last_.end() || sequence > last->second;
}

std::uint64_t SequenceWatch::missing_before(const WriterId& writer, std::uint64_t sequence) {
  const auto [entry, is_new] = last_.emplace(writer, sequence);
  if (is_new) {
    if (last_.size() > kMaxWriters) last_ = {{writer, sequence}};
    return 0;
  }
  if (sequence <= entry->second) return 0;
  const std::uint64_t missing = sequence - entry->second - 1;
  entry->second = sequence;
  return missing;
}

}  // namespace swiftlet
