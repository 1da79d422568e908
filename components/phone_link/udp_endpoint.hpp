// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace swiftlet {

/// An IPv4 address as a number: 127.0.0.1 is 0x7f000001.
using IpAddress = std::uint32_t;

/// Where a datagram came from, or goes to.
struct UdpEndpoint {
  IpAddress address = 0;
  std::uint16_t port = 0;
};
inline bool operator==(const UdpEndpoint& a, const UdpEndpoint& b) {
  return a.address == b.address && a.port == b.port;
}
inline bool operator!=(const UdpEndpoint& a, const UdpEndpoint& b) {
  return !(a == b);
}

/// "10.0.0.2"; nothing where it is no such address.
std::optional<IpAddress> parse_address(const std::string& text);
std::string to_string(IpAddress address);
/// "10.0.0.2:8787".
std::string to_string(const UdpEndpoint& endpoint);

}  // namespace swiftlet
