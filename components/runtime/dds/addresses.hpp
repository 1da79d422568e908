// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swiftlet {

/// "HOST" or "HOST:PORT".
struct HostAndPort {
  std::string host;
  std::optional<int> port;
};

// `option` is what the user wrote before the value, for the message of the error; "" leaves it out.

/// Throws ConfigError where the text is neither.
HostAndPort parse_host_and_port(const std::string& option, const std::string& text);

/// IPv4 address of a host that is given by address or name. Throws ConfigError.
std::string address_of_host(const std::string& option, const std::string& host);

/// IPv4 addresses of this host's interface `name`, or the one address where `name` is one of them.
/// Throws ConfigError where there is no such interface or address, and names those that there are;
/// RuntimeError where the interface is there and has no address.
std::vector<std::string> addresses_of_interface(const std::string& name);

/// The address of this host that packets to `address` would leave from. Throws RuntimeError where
/// there is no route.
std::string route_to(const std::string& option, const std::string& address);

}  // namespace swiftlet
