// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "components/bag/latched_samples.hpp"
#include "components/bag/loss_ledger.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// The samples of the last moments, in memory. Older ones go, and also newer ones where there are
/// more than `max_bytes`; of latched topics the last one stays.
class SampleWindow {
 public:
  /// What a window holds at one moment. It stays as it is while the window moves on.
  struct Content {
    std::vector<std::shared_ptr<const RecordedSample>> latched;  ///< from before the window
    std::vector<std::shared_ptr<const RecordedSample>> samples;
    mcap::Timestamp begin = 0;  ///< of the window [ns]
    LossLedger losses;          ///< since then
  };

  SampleWindow(Duration length, std::size_t max_bytes);

  void add(RecordedSample sample, bool latched);
  /// Notes what was lost from the beginning of the recording up to now.
  void note(const LossLedger& losses, mcap::Timestamp now);
  Content content(mcap::Timestamp now) const;

  /// Whether memory, not time, decided what had to go last.
  bool is_cut_short() const { return cut_short_; }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::shared_ptr<const RecordedSample> sample;
    bool latched = false;
  };
  mcap::Timestamp begin_at(mcap::Timestamp now) const { return now > length_ ? now - length_ : 0; }
  void drop_front();

  mcap::Timestamp length_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  bool cut_short_ = false;
  std::deque<Entry> entries_;
  LatchedSamples latched_;
  std::deque<std::pair<mcap::Timestamp, LossLedger>> losses_;  // whenever they changed
};

}  // namespace swiftlet
