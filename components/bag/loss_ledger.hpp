// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "components/bag/mcap/records.hpp"

namespace swiftlet {

/// Samples of one topic that were published and are not in the recording.
struct Loss {
  std::uint64_t by_dds = 0;       ///< did not arrive
  std::uint64_t by_recorder = 0;  ///< arrived, and the queue to the disk was full

  std::uint64_t total() const { return by_dds + by_recorder; }
  bool operator==(const Loss& other) const {
    return by_dds == other.by_dds && by_recorder == other.by_recorder;
  }
};

/// Losses by topic; topics without any need not be there.
using LossLedger = std::map<std::string, Loss>;

Loss total(const LossLedger& ledger);
void add(LossLedger& sum, const LossLedger& more);
/// What came on top of `before`, which was never larger.
LossLedger since(const LossLedger& before, const LossLedger& now);

/// Name of the metadata record that holds a ledger. It is written again when something was lost, at
/// most once a second, and counts from the beginning of the file: the last one in a file is true.
inline constexpr const char* kLossRecord = "swiftlet_losses";
/// Keys "dds/<topic>" and "recorder/<topic>" with numbers, and "time" with the time of the run
/// [ns].
mcap::Metadata to_metadata(const LossLedger& ledger, mcap::Timestamp time);
/// Nothing where the record is another, or a number in it is none.
std::optional<LossLedger> ledger_of(const mcap::Metadata& metadata);

/// Finds the gaps in what the writers of one topic numbered.
///
/// Each DDS writer counts its samples, and a reader gets them in that order, so that a number that
/// was left out did not arrive: lost on the network (best effort), overwritten in the writer's
/// history before it was acknowledged, or in the reader's before it was taken. What a writer wrote
/// before the first sample that arrived, and after the last, cannot be known.
class SequenceWatch {
 public:
  using WriterId = std::array<std::uint8_t, 16>;

  /// Whether it comes behind all that this writer wrote and that was heard.
  bool is_new(const WriterId& writer, std::uint64_t sequence) const;
  /// The number of samples that are missing in front of this one.
  std::uint64_t missing_before(const WriterId& writer, std::uint64_t sequence);

 private:
  std::map<WriterId, std::uint64_t> last_;
};

}  // namespace swiftlet
