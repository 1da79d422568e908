// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "components/runtime/dds/writer_guid.hpp"

namespace swiftlet {

/// Tells sequence numbers that a writer can have reached from those that it cannot, as RFC 3550,
/// A.1 does for RTP: a number that is far ahead of all before it is believed when those after it
/// say the same. Of some thousand writers; of more, the newest are known. Safe to use from any
/// thread.
class PlausibleSequence {
 public:
  /// How far ahead a number may be: a quarter of an hour at 1 kHz.
  static constexpr std::uint64_t kWindow = 1U << 20;
  /// So many in a row that agree are believed, wherever they are.
  static constexpr int kAgreeing = 16;

  PlausibleSequence();
  /// Whether `number` of the writer is to be believed. The first of a writer is.
  bool accept(const WriterGuid& writer, std::uint64_t number);

 private:
  struct Entry {
    WriterGuid writer{};
    std::uint64_t highest = 0;  ///< that was believed
    std::uint64_t refused = 0;  ///< the last that was not
    int agreeing = 0;           ///< refused in a row, one near the other
  };
  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace swiftlet
