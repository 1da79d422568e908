// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "components/runtime/dds/writer_guid.hpp"

namespace swiftlet {

/// Tells sizes of samples that are worth their memory from those that a single damaged fragment
/// claims: a reader takes as much memory as the first fragment of a sample says, and keeps it. A
/// size above kAlwaysBelieved is believed when several fragments of one sample agree on it, and
/// from then on such sizes of the same writer are. (Of the first large sample of a writer that
/// costs the first fragments, which a reliable one sends again.) Of some thousand writers; of more,
/// the newest are known. Safe to use from any thread.
class PlausibleSize {
 public:
  static constexpr std::uint32_t kAlwaysBelieved = 8U << 20;
  static constexpr int kAgreeing = 8;

  PlausibleSize();
  /// Whether sample `number` of the writer is to be believed to have `size` bytes.
  bool accept(const WriterGuid& writer, std::uint64_t number, std::uint32_t size);

 private:
  struct Entry {
    WriterGuid writer{};
    std::uint32_t believed = kAlwaysBelieved;  ///< sizes up to there
    std::uint64_t number = 0;                  ///< of the sample whose fragments claim more
    std::uint32_t size = 0;                    ///< what they claim
    int agreeing = 0;                          ///< how many did so in a row
  };
  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace swiftlet
