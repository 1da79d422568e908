// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/plausible_size.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kEntries = 4096;
/// Sizes of images and clouds differ from one to the next.
constexpr std::uint32_t kSameOrder = 2;

}  // namespace

PlausibleSize::PlausibleSize() : entries_(kEntries) {}

bool PlausibleSize::accept(const WriterGuid& writer, std::uint64_t number, std::uint32_t size) {
  if (size <= kAlwaysBelieved) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  Entry& entry = entries_[place_of(writer, kEntries)];
  if (entry.writer != writer) {
    entry = Entry{};
    entry.writer = writer;
  }
  if (size <= entry.believed) return true;
  const bool agrees = entry.agreeing > 0 && entry.number == number && entry.size == size;
  entry.agreeing = agrees ? entry.agreeing + 1 : 1;
  entry.number = number;
  entry.size = size;
  if (entry.agreeing < kAgreeing) return false;
  entry.believed = kSameOrder * size;
  entry.agreeing = 0;
  return true;
}

}  // namespace swiftlet
