// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/phone_link/phone_stream.hpp"
#include "components/phone_link/udp_endpoint.hpp"
#include "components/runtime/config/config.hpp"

namespace swiftlet {

inline constexpr std::uint16_t kPhonePort = 8787;

struct PhoneLinkParams {
  UdpEndpoint bind{0x7f000001, kPhonePort};  ///< loopback, unless told
  PhoneStream::Params stream;
};

/// Throws ConfigError.
PhoneLinkParams read_phone_link(const Config& config);

}  // namespace swiftlet
