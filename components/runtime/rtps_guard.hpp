// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "components/runtime/sequence_watch.hpp"

namespace swiftlet {

/// Keeps malformed RTPS datagrams from Fast DDS.
///
/// Fast DDS 2.9 believes what RTPS messages say of their own lengths, counts and numbers: with a
/// wrong one it reads behind the datagram, takes gigabytes, loops for hours or ends the process by
/// an assertion (tests/fuzz/README.md has the list). Checked is what RTPS 2.2, 8.3 and 9.4 demand
/// of every vendor: what is not known here passes if its length is sound. This is no security: who
/// can send to our ports and knows our writers can still speak in their name.
///
/// Safe to use from any thread.
class RtpsGuard {
 public:
  /// Why a datagram must not reach Fast DDS; null where it may.
  const char* problem(const std::uint8_t* datagram, std::size_t size);

 private:
  SequenceWatch numbers_;
};

}  // namespace swiftlet
