// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/sequence_watch.hpp"

namespace swiftlet {

void SequenceWatch::heard(std::uint16_t sequence) {
  if (last_) {
    const auto missing = static_cast<std::uint16_t>(sequence - *last_ - 1);
    if (missing <= kLargestGap) lost_ += missing;
  }
  last_ = sequence;
}

}  // namespace swiftlet
