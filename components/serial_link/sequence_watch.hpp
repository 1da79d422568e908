// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace swiftlet {

/// Counts the frames that are missing between those that came, by their numbers, which wrap around.
/// A jump of more than `kLargestGap`, or backwards, is a sender that began anew.
class SequenceWatch {
 public:
  static constexpr std::uint16_t kLargestGap = 4096;

  void heard(std::uint16_t sequence);
  std::uint64_t lost() const { return lost_; }

 private:
  std::optional<std::uint16_t> last_;
  std::uint64_t lost_ = 0;
};

}  // namespace swiftlet
