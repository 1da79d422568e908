// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "components/phone_link/udp_endpoint.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Whose datagrams count, and which of them are new. The first sender of a sound datagram is the
/// phone. While it is heard, all others are foreign; after a silence a sender may take its place:
/// from the same host only, unless `any_sender` lets every host.
class SenderWatch {
 public:
  struct Params {
    std::optional<IpAddress> only_from;  ///< nobody else's count, not even the first
    bool any_sender = false;
    double silence = 2.0;  ///< [s]
  };
  enum class Verdict {
    kNew,       ///< the next one of this phone
    kNewPhone,  ///< the first one: of all, or of a sender who takes over
    kForeign,
    kRepeated,
    kReordered,  ///< one with a later number was here before
  };

  explicit SenderWatch(const Params& params) : params_(params) {}

  /// A sound datagram arrived.
  Verdict judge(const UdpEndpoint& sender, std::uint32_t session, std::uint32_t sequence,
                Time arrival);
  /// The phone; nothing before the first sound datagram.
  const std::optional<UdpEndpoint>& phone() const { return phone_; }

 private:
  bool may_take_over(const UdpEndpoint& sender, Time arrival) const;
  Verdict judge_sequence(std::uint32_t sequence);

  Params params_;
  std::optional<UdpEndpoint> phone_;
  std::uint32_t session_ = 0;
  std::uint32_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: number newest_ - i was here
  Time last_heard_{};
};

}  // namespace swiftlet
