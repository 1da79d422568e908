// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/plausible_sequence.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

constexpr std::size_t kEntries = 4096;

}  // namespace

PlausibleSequence::PlausibleSequence() : entries_(kEntries) {}

bool PlausibleSequence::accept(const WriterGuid& writer, std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Entry& entry = entries_[place_of(writer, kEntries)];
  if (entry.writer != writer) entry = {writer, number, 0, 0};
  if (number <= entry.highest + kWindow) {
    entry.highest = std::max(entry.highest, number);
    entry.agreeing = 0;
    return true;
  }
  const bool agrees =
      entry.agreeing > 0 && number + kWindow >= entry.refused && number <= entry.refused + kWindow;
  entry.agreeing = agrees ? entry.agreeing + 1 : 1;
  entry.refused = number;
  if (entry.agreeing < kAgreeing) return false;
  entry.highest = number;
  entry.agreeing = 0;
  return true;
}

}  // namespace swiftlet
