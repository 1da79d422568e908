// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "components/runtime/dds/plausible_sequence.hpp"
#include "components/runtime/dds/plausible_size.hpp"

namespace swiftlet {

/// Keeps malformed RTPS datagrams from Fast DDS.
///
/// Fast DDS 2.9 believes what RTPS messages say of their own lengths, counts and numbers: with a
/// wrong one it reads behind the datagram, takes gigabytes, loops for hours or ends the process by
/// an assertion (tests/fuzz/README.md has the list). Checked is what RTPS 2.2, 8.3 and 9.4 demand
/// of every vendor: what is not known here passes if its length is sound. This is no security: who
/// can send to our ports and knows our writers can still speak in their name.
///
/// One thing is left to the caller. Fragments of one sample that contradict each other are sound
/// each by itself, and make Fast DDS read up to kFragmentOverrun bytes behind a datagram: what
/// brings fragments must have so much memory behind it.
///
/// Safe to use from any thread.
class RtpsGuard {
 public:
  static constexpr std::size_t kMostFragments = 16;  ///< in a submessage; all that is known has one
  static constexpr std::size_t kFragmentOverrun = kMostFragments << 16;

  struct Verdict {
    const char* problem = nullptr;  ///< why it must not reach Fast DDS; null where it may
    bool has_fragments = false;
    /// So many bytes may reach it: less than the datagram where its end was cut off, as it is by a
    /// receiver with less room (max_datagram) than the sender thinks.
    std::size_t size = 0;
  };
  Verdict judge(const std::uint8_t* datagram, std::size_t size);

 private:
  PlausibleSequence numbers_;
  PlausibleSize sizes_;
};

}  // namespace swiftlet
